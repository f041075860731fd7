// The pictures on the city's surfaces, for the light that they reflect.
#pragma once

#include "base/finding.h"
#include "base/progress.h"
#include "scene/scene.h"

namespace skybake {

/// Reads the textures that the scene's materials use into Scene::albedo_images; large pictures are averaged down to at
/// most 1024 pixels a side, which a bounce does not see. Finding SB408 for a picture that cannot be read; its surfaces
/// reflect kAlbedoWithoutTexture. Throws Interrupted.
void load_albedo_images(Scene& scene, FindingLog& findings, Progress& progress);

}  // namespace skybake
