// OpenEXR: the archive of a bake, and plain pictures such as sky panoramas.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/rgb.h"

namespace skybake::io {

enum class ExrType : std::uint8_t { uint32, float32 };

struct ExrChannel {
    std::string name;  // "R", or "layer.R"
    ExrType type = ExrType::float32;
};

/// Text attributes of the header, by name.
using ExrAttributes = std::vector<std::pair<std::string, std::string>>;

/// Fills one row: channels one after the other in the order of the call, `width` samples each; a float as its bits.
/// Called from several threads at once, for different rows.
using ExrRowFiller = std::function<void(int row, std::span<std::uint32_t> samples)>;

/// Writes a scan-line file with ZIP compression (lossless), all samples 32 bit. The same bytes for the same samples,
/// whatever the number of threads. Beside and renamed (io/file). Throws InputError when the place cannot be written.
void write_exr(const std::filesystem::path& path, int width, int height, std::span<const ExrChannel> channels,
               const ExrRowFiller& fill_row, const ExrAttributes& attributes = {});

/// A file that is open for reading: any compression, scan lines or tiles; of several parts the first one. Not
/// thread-safe; several files may be read at once.
class ExrReader {
  public:
    /// Reads the header. Throws InputError when the file is no EXR, is broken, or has more than `max_pixels`.
    explicit ExrReader(std::filesystem::path path, std::uint64_t max_pixels = 1ull << 28);
    ~ExrReader();
    ExrReader(const ExrReader&) = delete;
    ExrReader& operator=(const ExrReader&) = delete;

    int width() const;
    int height() const;
    bool has_channel(const std::string& name) const;
    /// What stands before the last dot of the channels' names, each once, sorted: "sky", "sun".
    std::vector<std::string> layers() const;

    /// Where a channel's samples go: row after row, `stride` 32-bit words from one to the next.
    struct Target {
        ExrChannel channel;
        void* first = nullptr;
        std::size_t stride = 1;
    };
    /// Reads whole channels; each target has room for width × height samples. Half and integer samples are converted to
    /// the asked type. Throws InputError when a channel is absent or the file is broken.
    void read(std::span<const Target> targets);
    /// The same for rows [first_row, first_row + row_count) only; the targets have room for these.
    void read_rows(int first_row, int row_count, std::span<const Target> targets);

  private:
    struct State;
    std::filesystem::path path_;
    std::unique_ptr<State> state_;
};

/// A linear picture, row 0 on top.
struct PictureRgb {
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels;
};

/// Channels R, G, B as 32-bit float. Throws InputError when the place cannot be written.
void write_exr_rgb(const std::filesystem::path& path, const PictureRgb& picture, const ExrAttributes& attributes = {});

/// Channels R, G, B, or the single channel Y for all three; values as they stand in the file, which may be negative or
/// not finite. Throws InputError when the file is broken, or has neither.
PictureRgb read_exr_rgb(const std::filesystem::path& path);

}  // namespace skybake::io
