// The folder of a bake, read back.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake/lightmap.h"
#include "base/rgb.h"
#include "io/exr/exr.h"
#include "io/manifest/bake_view.h"
#include "render/backdrop.h"

namespace skybake::io {

struct StoredPage {
    int width = 0;
    int height = 0;
    std::filesystem::path base;  // EXR with state, chart and sky view factor
};

struct StoredPanorama {
    int width = 0;
    int height = 0;
    std::filesystem::path file;  // four half floats a pixel, kcd m⁻²
};

struct StoredAir {
    AirScattering scattering;
    int columns = 0;
    int rows = 0;
    std::filesystem::path file;  // two tables of four half floats an entry, kcd m⁻²
};

struct StoredInstant {
    std::string label;
    std::vector<std::filesystem::path> pages;  // EXR with the light, one a page
    bool has_indirect = false;                 // the EXRs hold reflected light too
    BackdropSun sun;
    StoredPanorama panorama;
    BackdropLand land;
    std::optional<StoredAir> air;
    float exposure_hint = 1.0f;  // m² kcd⁻¹, positive
};

/// A file that the bake was made from.
struct StoredInput {
    std::string file;  // name without folder
    std::string sha256;
};

/// What the manifest says of the pages; the pages themselves are read one by one, since a city's may not fit into
/// memory.
struct StoredBake {
    std::filesystem::path folder;
    double texel_m = 0.0;
    std::uint64_t charts = 0;
    std::vector<StoredInput> inputs;
    std::vector<StoredPage> pages;
    std::vector<StoredInstant> instants;
    std::vector<BakeView> views;
    double convergence_rad = 0.0;  // true azimuth = grid azimuth + convergence
};

/// Names of the channels of a light EXR: R, G, B of the part.
enum class LightPart : std::uint8_t { total, sun, sky, indirect };
std::array<std::string, 3> channel_names(LightPart part);

/// Irradiance of one instant on one page, lx per channel; width × height entries each, row 0 on top.
struct StoredLight {
    std::vector<Rgb> total;
    std::vector<Rgb> sun;
    std::vector<Rgb> sky;
    std::vector<Rgb> indirect;  // empty in a bake without reflected light
};

/// Reads the manifest. Throws InputError when the folder holds no whole bake, or one of another version.
StoredBake open_bake(const std::filesystem::path& folder);

/// Throws InputError unless the file has as many texels as the manifest says of its page.
void check_size(const ExrReader& reader, const std::filesystem::path& path, const StoredPage& page);

/// Throws InputError when the file is broken or does not fit the manifest.
LightmapPage read_base(const StoredBake& bake, std::size_t page);
StoredLight read_light(const StoredBake& bake, std::size_t instant, std::size_t page);

}  // namespace skybake::io
