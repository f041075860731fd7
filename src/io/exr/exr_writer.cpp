// Scan-line files with ZIP compression, after the "OpenEXR File Layout" document of the OpenEXR project. Written here
// and not through the library since compressing takes most of the time of a bake's output: a page of light takes 1.2 s
// of one core instead of the library's 3.0 s, at the same size, and its blocks can be compressed by several threads.
// Reading is the library's work, and the tests read back through it.
#include <libdeflate.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <new>
#include <numeric>
#include <string_view>

#include "base/check.h"
#include "io/exr/exr.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

static_assert(std::endian::native == std::endian::little, "EXR is little-endian, and samples are copied as they are");

constexpr int kRowsPerBlock = 16;  // of ZIP_COMPRESSION
constexpr std::uint8_t kZipCompression = 3;
// Levels 1, 2, 4, 6 on a page of light: 1.2, 1.5, 1.65, 1.9 s of one core, and 62.7, 62.2, 62.2, 61.5 MB.
constexpr int kDeflateLevel = 1;
// Blocks that are compressed together before they are written: bounds the memory, and keeps 32 threads busy.
constexpr std::size_t kBlocksAtOnce = 64;

class Bytes {
  public:
    template <typename T>
    void number(T value) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof(T));
        std::memcpy(bytes_.data() + at, &value, sizeof(T));
    }
    void text(std::string_view value) { bytes_.insert(bytes_.end(), value.begin(), value.end()); }
    void name(std::string_view value) {
        text(value);
        number(std::uint8_t{0});
    }
    void attribute(std::string_view attribute_name, std::string_view type, const Bytes& value) {
        name(attribute_name);
        name(type);
        number(static_cast<std::int32_t>(value.bytes_.size()));
        bytes_.insert(bytes_.end(), value.bytes_.begin(), value.bytes_.end());
    }
    const std::vector<std::uint8_t>& get() const { return bytes_; }

  private:
    std::vector<std::uint8_t> bytes_;
};

template <typename... T>
Bytes numbers(T... values) {
    Bytes bytes;
    (bytes.number(values), ...);
    return bytes;
}

/// Magic number, version and attributes. `order` lists the channels by name, as the format wants them.
Bytes header(int width, int height, std::span<const ExrChannel> channels, std::span<const std::size_t> order,
             const ExrAttributes& attributes) {
    Bytes list;
    for (const std::size_t c : order) {
        list.name(channels[c].name);
        list.number(std::int32_t{channels[c].type == ExrType::uint32 ? 0 : 2});
        list.number(std::uint32_t{0});  // perceptually linear: no; and three reserved bytes
        list.number(std::int32_t{1});   // sampling in x and y: every pixel
        list.number(std::int32_t{1});
    }
    list.number(std::uint8_t{0});
    const Bytes window = numbers(std::int32_t{0}, std::int32_t{0}, std::int32_t{width - 1}, std::int32_t{height - 1});

    Bytes bytes;
    bytes.number(std::uint32_t{20000630});
    bytes.number(std::uint32_t{2});  // version 2, a single part of scan lines
    bytes.attribute("channels", "chlist", list);
    bytes.attribute("compression", "compression", numbers(kZipCompression));
    bytes.attribute("dataWindow", "box2i", window);
    bytes.attribute("displayWindow", "box2i", window);
    bytes.attribute("lineOrder", "lineOrder", numbers(std::uint8_t{0}));
    bytes.attribute("pixelAspectRatio", "float", numbers(1.0f));
    bytes.attribute("screenWindowCenter", "v2f", numbers(0.0f, 0.0f));
    bytes.attribute("screenWindowWidth", "float", numbers(1.0f));
    for (const auto& [name, value] : attributes) {
        Bytes text;
        text.text(value);
        bytes.attribute(name, "string", text);
    }
    bytes.number(std::uint8_t{0});
    return bytes;
}

/// Low and high bytes apart, then each byte less the one before it, about 128: what the format does before deflating.
void predict(std::span<const std::uint8_t> raw, std::span<std::uint8_t> predicted, std::span<std::uint8_t> scratch) {
    const std::size_t half = (raw.size() + 1) / 2;
    for (std::size_t i = 0; i < raw.size() / 2; ++i) {
        scratch[i] = raw[2 * i];
        scratch[half + i] = raw[2 * i + 1];
    }
    predicted[0] = scratch[0];
    for (std::size_t i = 1; i < raw.size(); ++i)
        predicted[i] = static_cast<std::uint8_t>(scratch[i] - scratch[i - 1] + 128);
}

/// Compresses blocks of rows; one object a task.
class BlockEncoder {
  public:
    BlockEncoder(int width, int height, std::span<const std::size_t> order, const ExrRowFiller& fill_row)
        : width_(static_cast<std::size_t>(width)),
          height_(height),
          order_(order),
          fill_row_(fill_row),
          row_(width_ * order.size()),
          compressor_(libdeflate_alloc_compressor(kDeflateLevel)) {
        if (compressor_ == nullptr) throw std::bad_alloc();
    }
    ~BlockEncoder() { libdeflate_free_compressor(compressor_); }
    BlockEncoder(const BlockEncoder&) = delete;
    BlockEncoder& operator=(const BlockEncoder&) = delete;

    std::vector<std::uint8_t> encode(int first_row) {
        const int rows = std::min(kRowsPerBlock, height_ - first_row);
        raw_.resize(row_.size() * static_cast<std::size_t>(rows));
        for (int y = 0; y < rows; ++y) {
            fill_row_(first_row + y, row_);
            std::uint32_t* out = raw_.data() + row_.size() * static_cast<std::size_t>(y);
            for (std::size_t k = 0; k < order_.size(); ++k)
                std::copy_n(row_.data() + order_[k] * width_, width_, out + k * width_);
        }
        const std::span<const std::uint8_t> raw(reinterpret_cast<const std::uint8_t*>(raw_.data()), raw_.size() * 4);
        predicted_.resize(raw.size());
        scratch_.resize(raw.size());
        predict(raw, predicted_, scratch_);
        // A block that does not shrink is stored as it is; so there is no need for room beyond its size.
        std::vector<std::uint8_t> block(raw.size());
        const std::size_t size =
            libdeflate_zlib_compress(compressor_, predicted_.data(), predicted_.size(), block.data(), block.size() - 1);
        if (size == 0) {
            std::copy(raw.begin(), raw.end(), block.begin());
        } else {
            block.resize(size);
            block.shrink_to_fit();
        }
        return block;
    }

  private:
    std::size_t width_;
    int height_;
    std::span<const std::size_t> order_;
    const ExrRowFiller& fill_row_;
    std::vector<std::uint32_t> row_;
    std::vector<std::uint32_t> raw_;
    std::vector<std::uint8_t> predicted_;
    std::vector<std::uint8_t> scratch_;
    libdeflate_compressor* compressor_;
};

std::span<const std::uint8_t> bytes_of(const std::vector<std::uint64_t>& values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(std::uint64_t)};
}

}  // namespace

void write_exr(const std::filesystem::path& path, int width, int height, std::span<const ExrChannel> channels,
               const ExrRowFiller& fill_row, const ExrAttributes& attributes) {
    SKYBAKE_CHECK(width > 0 && height > 0 && !channels.empty());
    std::vector<std::size_t> order(channels.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return channels[a].name < channels[b].name; });

    FileReplacement file(path);
    const Bytes head = header(width, height, channels, order, attributes);
    const std::size_t block_count = (static_cast<std::size_t>(height) + kRowsPerBlock - 1) / kRowsPerBlock;
    std::vector<std::uint64_t> offsets(block_count, 0);
    file.write(head.get());
    file.write(bytes_of(offsets));

    std::uint64_t offset = head.get().size() + block_count * sizeof(std::uint64_t);
    for (std::size_t first = 0; first < block_count; first += kBlocksAtOnce) {
        const std::size_t last = std::min(block_count, first + kBlocksAtOnce);
        std::vector<std::vector<std::uint8_t>> blocks(last - first);
        // Isolated, so that a thread that waits here does not begin the next file and hold the memory of both.
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, 4),
                              [&](const tbb::blocked_range<std::size_t>& range) {
                                  BlockEncoder encoder(width, height, order, fill_row);
                                  for (std::size_t b = range.begin(); b < range.end(); ++b)
                                      blocks[b - first] = encoder.encode(static_cast<int>(b) * kRowsPerBlock);
                              });
        });
        for (std::size_t b = first; b < last; ++b) {
            offsets[b] = offset;
            const std::vector<std::uint8_t>& block = blocks[b - first];
            file.write(
                numbers(static_cast<std::int32_t>(b) * kRowsPerBlock, static_cast<std::int32_t>(block.size())).get());
            file.write(block);
            offset += 8 + block.size();
        }
    }
    file.rewrite(head.get().size(), bytes_of(offsets));
    file.commit();
}

void write_exr_rgb(const std::filesystem::path& path, const PictureRgb& picture, const ExrAttributes& attributes) {
    SKYBAKE_CHECK_EQ(picture.pixels.size(),
                     static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    const std::array<ExrChannel, 3> channels = {ExrChannel{"R", ExrType::float32}, ExrChannel{"G", ExrType::float32},
                                                ExrChannel{"B", ExrType::float32}};
    const std::size_t width = static_cast<std::size_t>(picture.width);
    const auto fill_row = [&](int row, std::span<std::uint32_t> samples) {
        const Rgb* pixels = picture.pixels.data() + static_cast<std::size_t>(row) * width;
        for (std::size_t x = 0; x < width; ++x) {
            samples[x] = std::bit_cast<std::uint32_t>(pixels[x].x);
            samples[width + x] = std::bit_cast<std::uint32_t>(pixels[x].y);
            samples[2 * width + x] = std::bit_cast<std::uint32_t>(pixels[x].z);
        }
    };
    write_exr(path, picture.width, picture.height, channels, fill_row, attributes);
}

}  // namespace skybake::io
