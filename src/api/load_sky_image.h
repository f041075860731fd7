// The picture of an image sky.
#pragma once

#include "sky/sky_settings.h"

namespace skybake {

/// Reads the picture that `--sky image:FILE` names, and prepares it (sky/sky_level.h); nothing for other skies. An EXR
/// holds cd m⁻² per channel unless a scale is given, a Radiance picture W m⁻² sr⁻¹, of which 179 lm W⁻¹ make cd m⁻².
/// Negative and non-finite values become 0 (finding SB607, kept with the settings). Throws InputError when the file
/// cannot be read or is not twice as wide as high.
void load_sky_image(SkySettings& sky);

}  // namespace skybake
