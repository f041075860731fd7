// glTF, GLB and the b3dm tiles of 3D Tiles into a city.
#pragma once

#include <filesystem>

#include "base/finding.h"
#include "base/progress.h"
#include "city/city_model.h"
#include "io/assembly/city_assembly.h"

namespace skybake::io {

/// Adds the meshes of the asset to `city`, each node with a mesh as an object, of the types that materials name as in
/// OBJ files (io/assembly/mesh_objects). y is up unless `options.placement` says otherwise; the origin is added, and so
/// is the asset's own centre (CESIUM_RTC, RTC_CENTER). Coordinates that lie at the surface of the Earth about its
/// centre are taken as EPSG:4978. Triangles, strips and fans; buffers and images in the file, beside it or as data;
/// Draco, meshopt and quantised meshes; instances; KHR_texture_transform. The mean of COLOR_0 over a primitive
/// multiplies its base colour. Throws InputError when the file is unusable as a whole or requires an extension that is
/// not read, Interrupted when `progress` wants to stop; what is wrong with a part is a finding.
ReadFile read_gltf(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
                   Progress& progress);

}  // namespace skybake::io
