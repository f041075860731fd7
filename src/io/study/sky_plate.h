// The sky of one place: sun-path diagram with what hides it.
#pragma once

#include <string>

#include "io/study/report_words.h"
#include "study/study_pictures.h"

namespace skybake::io {

/// The diagram as SVG: sun paths of the year, the rule's days emphasised; grey what hides the sky, darker what is
/// behind the own wall, red what the plan hides in addition. `title` may be anybody's text.
std::string sky_plate_svg(const SamplePlate& plate, const Study& study, const StudySettings& settings,
                          const std::string& title, const Words& words);

/// The sunny intervals of a day in words: "09:12–11:40, 13:05–15:00", by the time zone's clock or UTC.
std::string sunny_times(const std::vector<SunInterval>& sunny, const SunDay& day,
                        const std::optional<std::string>& timezone);

/// An instant's clock time "HH:MM" by the offset of a zone on that day, or UTC.
std::string clock_of(UtcTime time, const std::optional<std::string>& timezone);

}  // namespace skybake::io
