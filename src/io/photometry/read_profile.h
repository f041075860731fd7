// Luminous intensity distributions of luminaires, as their makers publish them.
#pragma once

#include <filesystem>

#include "light/light_profile.h"

namespace skybake::io {

/// Reads IES LM-63 (1986, 1991, 1995, 2002; type C) or EULUMDAT, whichever the content is: LM-63 has a line with TILT=.
/// Symmetric halves and quarters are completed. Throws InputError, with file and line, for what is broken, for types A
/// and B and for a tilt of lamps.
LightProfile read_profile(const std::filesystem::path& path);

}  // namespace skybake::io
