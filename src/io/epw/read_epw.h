// Reads EnergyPlus weather files (EPW).
#pragma once

#include <filesystem>

#include "base/finding.h"
#include "sky/weather.h"

namespace skybake::io {

/// The rows of an EPW file as they stand there, values that the format marks as missing left empty; settle_weather is
/// still to be called. Based on: EnergyPlus, Auxiliary Programs, "EnergyPlus Weather File (EPW) Data Dictionary".
/// Understood are LF, CR LF and CR, a byte order mark, missing header lines (but LOCATION, which is the first), any
/// number of records an hour, 32 to 35 columns, hours 0…24. With several records an hour the label is hour − 1 and the
/// minutes. Findings: SB701 a row that cannot be read, SB702 impossible irradiance, SB703 a moment that stands there
/// twice (all left out), SB715 a header line that is missing or wrong. Throws InputError for a file that cannot be
/// read, is no EPW, has no usable place or time zone, or no usable row.
Weather read_epw(const std::filesystem::path& path, FindingLog& findings);

}  // namespace skybake::io
