// The light of an hour of weather: what a weather file makes of the sky and the beam that were asked for.
#pragma once

#include "sky/daylight_settings.h"

namespace skybake {

/// The weather of an instant. Throws InputError where the file has no radiation.
WeatherHour weather_of(const Weather& weather, const Instant& instant);

/// The asked model at the hour's level. The Preetham sky takes its diffuse irradiance; uniform and none keep their own
/// level.
SkySettings sky_of_weather(const SkySettings& asked, const WeatherHour& hour);

/// Gives the beam the hour's direct irradiance, where the sun is up and asked for. Colour and luminous efficacy are
/// those of a clear beam of the turbidity; the efficacy is taken at 5° or higher, below which the clear sky's
/// irradiance is an extrapolation.
void set_beam(SunBeam& beam, const WeatherHour& hour, double turbidity, double sun_zenith_rad, double distance_au);

/// Reports what was found in the file, and how its place and days fit what is asked: SB711, SB712, SB713. `site` is the
/// place that is known without the file.
void find_weather(const DaylightSettings& settings, const std::optional<Site>& site, FindingLog& findings);

}  // namespace skybake
