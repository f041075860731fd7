// Files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>
#include <vector>

namespace skybake::io {

/// A file that is written beside its place ("NAME.part") and takes its name only in commit(): a killed or failed run
/// leaves no half file that looks whole. Without commit() the destructor removes what was written. Throws InputError
/// when the place cannot be written or the disk is full. Not thread-safe; several objects for different paths may be
/// used at once.
class FileReplacement {
  public:
    explicit FileReplacement(std::filesystem::path path);
    ~FileReplacement();
    FileReplacement(const FileReplacement&) = delete;
    FileReplacement& operator=(const FileReplacement&) = delete;

    void write(std::span<const std::uint8_t> bytes);
    void write(std::string_view text);
    /// Overwrites bytes that were written before; `offset` counts from the beginning of the file. Appending goes on at
    /// the end.
    void rewrite(std::uint64_t offset, std::span<const std::uint8_t> bytes);
    /// Closes the file and gives it its name, in place of an older one.
    void commit();

    /// Where the bytes are until commit(): for libraries that want to open the file themselves.
    const std::filesystem::path& part_path() const { return part_; }

  private:
    [[noreturn]] void fail(const char* what) const;
    std::filesystem::path path_;
    std::filesystem::path part_;
    std::ofstream stream_;
    bool is_committed_ = false;
};

/// Writes `bytes` as the whole file, through FileReplacement.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

/// The whole file. Throws InputError when it cannot be read, is a folder, or is larger than `max_bytes`.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uint64_t max_bytes = 1ull << 32);

}  // namespace skybake::io
