// The option --diagram of `skybake sun`: what stands in the picture, in words and numbers.
#pragma once

#include <optional>
#include <string>

#include "base/site.h"
#include "io/svg/sun_diagram.h"
#include "sky/daylight_settings.h"

namespace skybake::cli {

struct DiagramOptions {
    std::string file;
    std::string projection = "stereographic";
    std::string hours;  // "clock", "solar", or empty: clock where an offset from UTC is known
};

/// The year that is drawn when no instant names one.
inline constexpr int kDiagramYear = 2026;

/// The diagram of a site with the instants of the settings marked. `timezone` is an IANA name or empty. Throws
/// InputError for unknown words, and for clock hours where neither instants, time zone nor weather tell the offset.
io::SunDiagram sun_path_diagram(const DiagramOptions& options, const DaylightSettings& settings,
                                const std::string& timezone, const Site& site);

}  // namespace skybake::cli
