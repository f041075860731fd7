#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <set>

#include "base/check.h"
#include "base/error.h"
#include "io/exr/exr.h"

namespace skybake::io {

struct ExrReader::State {
    std::optional<Imf::InputFile> file;
    int width = 0;
    int height = 0;
    int x_min = 0;
    int y_min = 0;
};

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* reason) {
    throw InputError(fmt::format("{}: broken EXR, or none ({}). Write the file anew.", path.string(), reason));
}

}  // namespace

ExrReader::ExrReader(std::filesystem::path path, std::uint64_t max_pixels)
    : path_(std::move(path)), state_(std::make_unique<State>()) {
    try {
        state_->file.emplace(path_.c_str(), 0);
    } catch (const std::exception& error) {
        fail(path_, error.what());
    }
    const Imath::Box2i window = state_->file->header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width <= 0 || height <= 0) fail(path_, "its window is empty");
    if (static_cast<std::uint64_t>(width) > max_pixels / static_cast<std::uint64_t>(height)) {
        throw InputError(fmt::format("{}: {} x {} pixels are more than the {} that are read. Scale the picture down.",
                                     path_.string(), width, height, max_pixels));
    }
    state_->width = static_cast<int>(width);
    state_->height = static_cast<int>(height);
    state_->x_min = window.min.x;
    state_->y_min = window.min.y;
}

ExrReader::~ExrReader() = default;

int ExrReader::width() const {
    return state_->width;
}
int ExrReader::height() const {
    return state_->height;
}
bool ExrReader::has_channel(const std::string& name) const {
    return state_->file->header().channels().findChannel(name) != nullptr;
}

std::vector<std::string> ExrReader::layers() const {
    std::set<std::string> names;
    state_->file->header().channels().layers(names);
    return {names.begin(), names.end()};
}

void ExrReader::read(std::span<const Target> targets) {
    read_rows(0, state_->height, targets);
}

void ExrReader::read_rows(int first_row, int row_count, std::span<const Target> targets) {
    SKYBAKE_CHECK(first_row >= 0 && row_count > 0 && row_count <= state_->height - first_row);
    Imf::FrameBuffer frame;
    for (const Target& target : targets) {
        if (!has_channel(target.channel.name)) {
            throw InputError(fmt::format("{}: has no channel '{}'. Is it of another bake, or another kind of picture?",
                                         path_.string(), target.channel.name));
        }
        const Imf::Channel& channel = *state_->file->header().channels().findChannel(target.channel.name);
        if (channel.xSampling != 1 || channel.ySampling != 1) fail(path_, "a channel leaves out pixels");
        const Imf::PixelType type = target.channel.type == ExrType::uint32 ? Imf::UINT : Imf::FLOAT;
        // The library counts from the window's corner, which need not be (0, 0): the base pointer is that of the pixel
        // (0, 0).
        const std::ptrdiff_t pixel = static_cast<std::ptrdiff_t>(target.stride * 4);
        const std::ptrdiff_t row = pixel * state_->width;
        char* base = static_cast<char*>(target.first) - pixel * state_->x_min - row * (state_->y_min + first_row);
        frame.insert(target.channel.name,
                     Imf::Slice(type, base, static_cast<std::size_t>(pixel), static_cast<std::size_t>(row)));
    }
    try {
        state_->file->setFrameBuffer(frame);
        state_->file->readPixels(state_->y_min + first_row, state_->y_min + first_row + row_count - 1);
    } catch (const std::exception& error) {
        fail(path_, error.what());
    }
}

PictureRgb read_exr_rgb(const std::filesystem::path& path) {
    ExrReader reader(path);
    PictureRgb picture{reader.width(), reader.height(), {}};
    picture.pixels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    const bool is_grey = !reader.has_channel("R") && reader.has_channel("Y");
    if (is_grey && (reader.has_channel("RY") || reader.has_channel("BY"))) {
        throw InputError(fmt::format("{}: stores luminance and chroma. Convert it to R, G, B.", path.string()));
    }
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    float* first = &picture.pixels.data()->x;
    if (is_grey) {
        reader.read(std::vector<ExrReader::Target>{{{"Y", ExrType::float32}, first, 3}});
        for (Rgb& pixel : picture.pixels) pixel = Rgb(pixel.x);
    } else {
        reader.read(std::vector<ExrReader::Target>{{{"R", ExrType::float32}, first, 3},
                                                   {{"G", ExrType::float32}, first + 1, 3},
                                                   {{"B", ExrType::float32}, first + 2, 3}});
    }
    return picture;
}

}  // namespace skybake::io
