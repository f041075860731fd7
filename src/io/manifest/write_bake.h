// The folder of a bake: pages, GLB and manifest (docs/formats.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atlas/atlas.h"
#include "bake/bake_report.h"
#include "bake/lightmap.h"
#include "base/finding.h"
#include "base/progress.h"
#include "base/site.h"
#include "io/gltf/glb.h"
#include "io/manifest/bake_view.h"
#include "io/manifest/write_objects.h"
#include "scene/scene.h"
#include "sky/aerial_perspective.h"

namespace skybake::io {

/// What the manifest says about an instant beyond its daylight.
struct InstantDescription {
    std::optional<std::string> utc;  // ISO 8601 with Z; none when the sun's direction was given
    std::string sky_model;           // as --sky takes it: "preetham:turbidity=3"
    std::vector<Rgb> sky_panorama;   // sky_panorama(sky, kPanoramaWidth, kPanoramaHeight), cd m⁻²
    Rgb land_luminance{0.0f};        // cd m⁻²
    std::optional<Air> air;          // none without a sky
};

inline constexpr int kPanoramaWidth = 512;
inline constexpr int kPanoramaHeight = 128;

/// What the manifest says so that the bake can be understood, and made again.
struct BakeDescription {
    std::string version;  // of skybake
    std::string title;
    std::string crs;  // code and name; empty when unknown
    std::optional<Site> site;
    double convergence_rad = 0.0;
    std::uint64_t seed = 0;
    std::uint64_t sky_samples = 0;
    std::string sampling;  // "hierarchical" or "full"
    double tolerance = 0.0;
    std::vector<std::pair<std::string, std::string>>
        settings;  // options as given: name and value; nothing that leaves the bytes alone (--threads)
    std::vector<std::filesystem::path> inputs;  // their names, sizes and SHA-256 go into the manifest
    std::string isa;
    std::vector<InstantDescription> instants;  // one an instant of the lightmaps
    std::vector<BakeView> views;
    AttributesOf attributes;  // of the city's objects
};

struct BakeOutput {
    const Scene& scene;
    const Atlas& atlas;
    const Lightmaps& light;
    const BakeDescription& description;
    const BakeReport& report;
    const FindingLog& findings;
};

struct WrittenBake {
    GlbSummary glb;
    std::uint64_t files = 0;  // without the manifest
    std::uint64_t bytes = 0;
};

/// Throws InputError when a bake cannot be written to the folder, before hours of work; makes nothing.
void check_output_folder(const std::filesystem::path& folder);

/// Writes the whole folder, which is made if it is absent. What an older or a killed bake left in it is removed first,
/// its manifest before all else, and the new manifest is written last: a folder with a manifest is whole. Other files
/// in the folder stay. The same bytes for the same output, whatever the number of threads; wall-clock figures of the
/// report are left out for that. Throws InputError when the place cannot be written or an input cannot be read,
/// Interrupted when the user stops.
WrittenBake write_bake(const std::filesystem::path& folder, const BakeOutput& output, Progress& progress);

}  // namespace skybake::io
