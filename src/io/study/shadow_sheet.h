// Shadows at the whole hours of a day on one sheet: the fan ("butterfly") of a plan, or the shadows of a city.
#pragma once

#include <string>
#include <vector>

#include "io/study/report_words.h"
#include "study/study_pictures.h"

namespace skybake::io {

/// The shadows of one kind on one day over each other, hour by hour in its own colour, on `map`; with `shaded_below`
/// another kind as a tint below the lines. Empty when there is none.
std::string shadow_fan_svg(const StudyPictures& pictures, const MapGround& map, std::size_t day, ShadowKind lines,
                           ShadowKind tint, const Words& words, double convergence_rad);

/// One map of the shadows at one instant.
std::string shadow_instant_svg(const HourShadow& shadow, const MapGround& map, const Words& words,
                               double convergence_rad);

}  // namespace skybake::io
