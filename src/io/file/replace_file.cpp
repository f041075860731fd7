#include "io/file/replace_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace skybake::io {

FileReplacement::FileReplacement(std::filesystem::path path) : path_(std::move(path)), part_(path_.string() + ".part") {
    errno = 0;
    stream_.open(part_, std::ios::binary | std::ios::trunc);
    if (!stream_) fail("cannot be written");
}

FileReplacement::~FileReplacement() {
    if (is_committed_) return;
    stream_.close();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
}

void FileReplacement::fail(const char* what) const {
    const std::string reason = errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : std::string();
    throw InputError(fmt::format("{}: {}{}. Choose another place, or make room there.", path_.string(), what, reason));
}

void FileReplacement::write(std::span<const std::uint8_t> bytes) {
    errno = 0;
    stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream_) fail("cannot be written");
}

void FileReplacement::write(std::string_view text) {
    write(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void FileReplacement::rewrite(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
    stream_.seekp(static_cast<std::streamoff>(offset));
    write(bytes);
    stream_.seekp(0, std::ios::end);
}

void FileReplacement::commit() {
    errno = 0;
    stream_.close();
    if (stream_.fail()) fail("cannot be written to its end");
    std::error_code error;
    std::filesystem::rename(part_, path_, error);
    if (error) {
        errno = error.value();
        fail("cannot take its name");
    }
    is_committed_ = true;
}

void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
    FileReplacement file(path);
    file.write(bytes);
    file.commit();
}

std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        throw InputError(fmt::format("{}: is a folder, not a file.", path.string()));
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw InputError(fmt::format("{}: cannot be read ({}).", path.string(), std::strerror(errno)));
    std::vector<std::uint8_t> bytes;
    // Read in blocks rather than by the stated size, so that pipes and files that grow are read whole, too.
    constexpr std::size_t kBlock = std::size_t{1} << 20;
    const std::uintmax_t stated = std::filesystem::file_size(path, error);
    if (!error && stated <= max_bytes) bytes.reserve(static_cast<std::size_t>(stated));
    while (stream) {
        const std::size_t begin = bytes.size();
        bytes.resize(begin + kBlock);
        stream.read(reinterpret_cast<char*>(bytes.data() + begin), static_cast<std::streamsize>(kBlock));
        bytes.resize(begin + static_cast<std::size_t>(stream.gcount()));
        if (bytes.size() > max_bytes) {
            throw InputError(fmt::format("{}: is larger than {} bytes, which no file of its kind should be.",
                                         path.string(), max_bytes));
        }
    }
    if (stream.bad())
        throw InputError(fmt::format("{}: cannot be read to its end ({}).", path.string(), std::strerror(errno)));
    return bytes;
}

}  // namespace skybake::io
