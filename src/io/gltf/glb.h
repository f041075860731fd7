// The lit city as one glTF 2.0 binary that every viewer opens: docs/formats.md says what stands where.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "atlas/atlas.h"
#include "base/vec.h"
#include "scene/scene.h"

namespace skybake::io {

struct GlbInfo {
    std::string generator = "skybake";
    std::string crs;  // goes with the origin into the scene's extras, so that the city can be put back on the map
};

struct GlbSummary {
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::uint64_t primitives = 0;         // draw calls
    std::uint64_t images = 0;             // albedo textures that were embedded
    std::uint64_t textures_left_out = 0;  // missing, or neither PNG nor JPEG: their materials got a plain colour
    std::uint64_t bytes = 0;
};

/// Writes all triangles that belong to a chart, y up (x = east, y = up, z = south; metres about Scene::origin), one
/// primitive for each scene material and page. TEXCOORD_0 leads into the albedo texture, TEXCOORD_1 into the lightmap
/// page ([0, 1], v down), `_CHART` is the chart's index. `sky_view_pngs` has an encoded PNG for each page, embedded as
/// the core occlusion texture; they and the normals stand last, so that who does without may stop reading. Beside the
/// scene it needs some 20 bytes a triangle; the file itself is streamed. Beside and renamed (io/file). Throws
/// InputError when the place cannot be written, or the file would pass glTF's limit of 4 GiB.
GlbSummary write_glb(const std::filesystem::path& path, const Scene& scene, const Atlas& atlas,
                     std::span<const std::vector<std::uint8_t>> sky_view_pngs, const GlbInfo& info);

}  // namespace skybake::io
