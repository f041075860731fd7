#include "io/manifest/read_picture.h"

#include <Imath/half.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <optional>

#include "base/error.h"
#include "io/exr/exr.h"
#include "io/file/replace_file.h"
#include "io/gltf/read_glb.h"
#include "io/manifest/names.h"

namespace skybake::io {
namespace {

/// Pages read side by side: `read(page)` gives the texels of one.
template <typename Read>
SurfaceLight read_pages(const StoredBake& bake, const Read& read) {
    std::vector<std::optional<LightPage>> pages(bake.pages.size());
    tbb::parallel_for(std::size_t{0}, pages.size(),
                      [&](std::size_t p) { pages[p].emplace(bake.pages[p].width, bake.pages[p].height, read(p)); });
    SurfaceLight light;
    for (std::optional<LightPage>& page : pages) light.push_back(std::move(*page));
    return light;
}

std::vector<Rgb> read_layer(const StoredBake& bake, std::size_t instant, std::size_t page, const std::string& prefix) {
    const std::filesystem::path& path = bake.instants[instant].pages[page];
    ExrReader reader(path);
    check_size(reader, path, bake.pages[page]);
    std::vector<Rgb> texels(static_cast<std::size_t>(reader.width()) * static_cast<std::size_t>(reader.height()));
    std::vector<ExrReader::Target> targets;
    for (const auto& [name, channel] : {std::pair{"R", &texels[0].x}, {"G", &texels[0].y}, {"B", &texels[0].z}})
        targets.push_back({{prefix + name, ExrType::float32}, channel, 3});
    reader.read(targets);
    for (const Rgb& texel : texels) {
        if (!std::isfinite(texel.x + texel.y + texel.z))
            throw InputError(fmt::format("{}: holds light that is not finite. Bake again.", path.string()));
    }
    return texels;
}

/// Four halves a pixel (the last one 1), kcd m⁻² in the file, cd m⁻² here; width × height of them.
std::vector<Rgb> read_half_pixels(const std::filesystem::path& path, int width, int height) {
    const std::vector<std::uint8_t> bytes = read_file(path);
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (bytes.size() != 8 * count) {
        throw InputError(fmt::format("{}: has {} bytes, and the manifest's {} x {} pixels need {}. Bake again.",
                                     path.string(), bytes.size(), width, height, 8 * count));
    }
    std::vector<Rgb> pixels(count);
    for (std::size_t i = 0; i < 3 * count; ++i) {
        const std::size_t at = 8 * (i / 3) + 2 * (i % 3);
        Imath::half value;
        value.setBits(static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8));
        if (!value.isFinite())
            throw InputError(fmt::format("{}: holds light that is not finite. Bake again.", path.string()));
        pixels[i / 3][static_cast<int>(i % 3)] = 1e3f * static_cast<float>(value);
    }
    return pixels;
}

}  // namespace

std::vector<std::string> light_parts(const StoredBake& bake, std::size_t instant) {
    if (bake.pages.empty()) return {};
    const ExrReader reader(bake.instants[instant].pages.front());
    return reader.layers();
}

PictureScene read_city(const StoredBake& bake) {
    std::vector<Vec2i> sizes;
    for (const StoredPage& page : bake.pages) sizes.emplace_back(page.width, page.height);
    return read_glb(bake.folder / names::kCity, sizes);
}

SurfaceLight read_illuminance(const StoredBake& bake, std::size_t instant, const PartFactors& parts) {
    return read_pages(bake, [&](std::size_t page) {
        if (parts.empty()) return read_layer(bake, instant, page, "");
        std::vector<Rgb> sum;
        for (const auto& [name, factor] : parts) {
            const std::vector<Rgb> layer = read_layer(bake, instant, page, name + ".");
            sum.resize(layer.size(), Rgb(0.0f));
            for (std::size_t t = 0; t < layer.size(); ++t) sum[t] += factor * layer[t];
        }
        return sum;
    });
}

SurfaceLight read_sky_view(const StoredBake& bake) {
    return read_pages(bake, [&](std::size_t page) {
        const LightmapPage base = read_base(bake, page);
        std::vector<Rgb> texels;
        texels.reserve(base.sky_view_factor.size());
        for (const float factor : base.sky_view_factor) texels.emplace_back(factor);
        return texels;
    });
}

Backdrop read_backdrop(const StoredBake& bake, std::size_t instant, AirUse use) {
    const StoredInstant& stored = bake.instants[instant];
    const StoredPanorama& panorama = stored.panorama;
    std::optional<Air> air;
    if (stored.air && use == AirUse::seen) {
        air = Air{stored.air->scattering, Vec3d(stored.sun.direction), stored.air->columns, stored.air->rows, {}, {}};
        const std::vector<Rgb> tables = read_half_pixels(stored.air->file, 2 * air->columns, air->rows);
        const auto middle = tables.begin() + static_cast<std::ptrdiff_t>(tables.size() / 2);
        air->molecule_airlight.assign(tables.begin(), middle);
        air->haze_airlight.assign(middle, tables.end());
    }
    return {{panorama.width, panorama.height, read_half_pixels(panorama.file, panorama.width, panorama.height)},
            stored.sun,
            stored.land,
            std::move(air)};
}

}  // namespace skybake::io
