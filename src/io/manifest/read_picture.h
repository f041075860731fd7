// What a still picture needs of a bake's folder.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/manifest/read_bake.h"
#include "render/picture_scene.h"

namespace skybake::io {

/// Which parts of the light a picture shows: names of EXR layers with their factors.
using PartFactors = std::vector<std::pair<std::string, float>>;

/// The parts that an instant of the bake stores, by the layers of its first EXR: "sun", "sky", "indirect" … Sorted by
/// name. Throws InputError when the file is broken; empty for a bake without pages.
std::vector<std::string> light_parts(const StoredBake& bake, std::size_t instant);

/// city.glb of the bake.
PictureScene read_city(const StoredBake& bake);

/// Illuminance, lx: the sum of the named parts times their factors; without any, the total as it stands in the file.
SurfaceLight read_illuminance(const StoredBake& bake, std::size_t instant, const PartFactors& parts);

/// The sky view factor, 0…1, in all three channels.
SurfaceLight read_sky_view(const StoredBake& bake);

enum class AirUse : std::uint8_t { seen, left_out };

/// Sky, sun and land about the city at an instant, and the air before it where the bake has it and `air` asks for it.
Backdrop read_backdrop(const StoredBake& bake, std::size_t instant, AirUse air);

}  // namespace skybake::io
