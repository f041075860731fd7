// The option --weather: a weather file that sets the level of the light.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "sky/daylight_settings.h"

namespace skybake::cli {

/// Reads the EPW file, makes it fit for light, and puts it with its findings into the settings. Throws InputError for
/// an unusable file.
void put_weather(DaylightSettings& settings, const std::string& file);

/// What the file is and holds: place, rows, the hours' middle and the sums of the year.
nlohmann::json weather_json(const Weather& weather);
/// The same for humans, on stdout.
void print_weather(const Weather& weather);

}  // namespace skybake::cli
