// The light of an hour of weather: what a weather file makes of the sky and the beam that were asked for.
#pragma once

#include "sky/daylight_settings.h"

namespace skybake {

/// The weather of an instant. Throws InputError where the file has no radiation.
WeatherHour weather_of(const Weather& weather, const Instant& instant);

/// The hour as a Perez sky, whose beam is the hour's under every sky. The precipitable water follows from the dew point
/// (Perez et al. 1990, equation 3: w = exp(0.07 Td − 0.075) cm); 2 cm without one.
PerezSettings weather_sky(const WeatherHour& hour);

/// The asked model at the hour's level: Perez takes all of it, Preetham and the CIE's skies (unless their zenith is
/// given) its diffuse irradiance; uniform, none and image skies keep their own level.
SkySettings sky_of_weather(const SkySettings& asked, const WeatherHour& hour);

/// Reports what was found in the file, and how its place and days fit what is asked: SB711, SB712, SB713. `site` is the
/// place that is known without the file.
void find_weather(const DaylightSettings& settings, const std::optional<Site>& site, FindingLog& findings);

}  // namespace skybake
