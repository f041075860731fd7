// The two kinds of lamp files, parsed: for read_lamps alone.
#pragma once

#include <nlohmann/json.hpp>

#include "io/lamps/read_lamps.h"

namespace skybake::io {

/// Our own format.
LampFile lamps_of_json(const nlohmann::json& file, const std::filesystem::path& path, const Vec3d& origin);

/// Of glTF 2.0, extension KHR_lights_punctual: point and spot lights of all nodes of the scene.
LampFile lamps_of_gltf(const nlohmann::json& gltf, const std::filesystem::path& path, const Vec3d& origin,
                       const std::optional<Vec3d>& gltf_origin, FindingLog& findings);

}  // namespace skybake::io
