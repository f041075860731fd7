#include "sky/sky_level.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/check.h"
#include "sky/clear_sky.h"
#include "sky/gensky_level.h"
#include "sky/sun_beam.h"

namespace skybake {

namespace {

constexpr double kPrecipitableWaterCm = 2.0;  // of the beam and of clear_sky_irradiance

double extraterrestrial(const SeenSun& sun) {
    return kSolarConstant / (sun.distance_au * sun.distance_au);
}

/// Diffuse illuminance of a clear sky, lx, and the efficacy that brings its irradiance there.
struct ClearLevel {
    double illuminance_lx = 0.0;
    double efficacy_lm_w = kOvercastEfficacy;
};

/// `dhi_w_m2` instead of the clear sky's own irradiance.
ClearLevel clear_level(double turbidity, const SeenSun& sun, std::optional<double> dhi_w_m2) {
    const double day_zenith =
        std::min(sun.zenith_rad(), radians_from_degrees(87.0));  // where all the formulas for daytime still hold
    const ClearSkyIrradiance day = clear_sky_irradiance(turbidity, day_zenith, sun.distance_au);
    const double clear_dhi = clear_sky_irradiance(turbidity, sun.zenith_rad(), sun.distance_au).dhi;
    const double dhi = dhi_w_m2.value_or(clear_dhi);
    ClearLevel level;
    level.efficacy_lm_w = smooth_diffuse_luminous_efficacy(day.dni, dhi_w_m2.value_or(0.0) > 0.0 ? dhi : day.dhi,
                                                           day_zenith, extraterrestrial(sun), kPrecipitableWaterCm);
    level.illuminance_lx = dhi * level.efficacy_lm_w;
    return level;
}

/// Of the sky when the sun is on the horizon or below: what is left of the day, and a floor for the rest of it.
double dusk_illuminance(const SeenSun& sun) {
    return twilight_illuminance(std::min(sun.elevation_rad, 0.0));
}

/// How a CIE sky comes to what the standard leaves open. Our choice: the turbidities are of the order of the luminous
/// turbidities that Darula & Kittler, "CIE general sky standard defining luminance distributions", 2002, call typical
/// of the types; types 1…6 hide the sun.
enum class Clouds { overcast, broken, none };
struct CieAir {
    Clouds clouds = Clouds::none;
    double clear_share = 1.0;         // of the colour
    std::optional<double> turbidity;  // nothing: no sun
};

CieAir air_of_type(int type) {
    constexpr double kTurbidity[9] = {12.0, 10.0, 12.0, 10.0, 4.0, 2.5, 4.5, 5.0, 4.0};  // types 7…15
    if (type <= 5) return {Clouds::overcast, 0.0, std::nullopt};
    if (type == 6) return {Clouds::broken, 0.3, std::nullopt};
    return {type <= 10 ? Clouds::broken : Clouds::none, type <= 10 ? 0.5 : 1.0, kTurbidity[type - 7]};
}

CieAir air_of_type(Cie1994Type type) {
    switch (type) {
        case Cie1994Type::clear:
            return air_of_type(12);
        case Cie1994Type::turbid_clear:
            return air_of_type(13);
        case Cie1994Type::intermediate:
            return air_of_type(8);
        case Cie1994Type::overcast:
            break;
    }
    return air_of_type(1);
}

/// The turbidity that the user states, if it is one of Preetham's kind: gensky's is not.
std::optional<double> stated_turbidity(const CieSettings& settings) {
    return settings.turbidity;
}
std::optional<double> stated_turbidity(const Cie1994Settings& settings) {
    return settings.level == Cie1994Level::gensky ? std::nullopt : settings.turbidity;
}

/// The air as the user has it.
template <typename Cie>
CieAir air_of(const Cie& settings) {
    CieAir air = air_of_type(settings.type);
    if (air.turbidity) air.turbidity = stated_turbidity(settings).value_or(*air.turbidity);
    return air;
}

/// Of the clear air: the blue between clouds is that of clear air, however little the clouds leave of the sun.
template <typename Cie>
double clear_turbidity(const Cie& settings) {
    const CieAir air = air_of_type(settings.type);
    return stated_turbidity(settings).value_or(air.clouds == Clouds::none ? *air.turbidity : kDefaultTurbidity);
}

/// Based on: Krochmann & Seidl, "Quantitative data on daylight for illuminating engineering", Lighting Research &
/// Technology 6, 1974: overcast sky, horizontal illuminance.
double overcast_illuminance(double sun_elevation_rad) {
    return sun_elevation_rad > 0.0 ? 300.0 + 21'000.0 * std::sin(sun_elevation_rad) : 0.0;
}

/// Broken clouds: 0.4 of the extraterrestrial horizontal illuminance, the order of what Kittler, Perez, Darula, "A set
/// of standard skies", 1998, report for their intermediate types.
double broken_illuminance(const SeenSun& sun) {
    constexpr double kExtraterrestrialLx = 133'100.0;
    return 0.4 * kExtraterrestrialLx / (sun.distance_au * sun.distance_au) * std::sin(std::max(sun.elevation_rad, 0.0));
}

/// Level and colour for either CIE sky.
template <typename Sky, typename Settings>
Sky with_level(Sky sky, const Settings& settings, const CieAir& air, const SeenSun& sun) {
    double illuminance_lx = 0.0;
    sky.efficacy_lm_w = kOvercastEfficacy;
    if (air.clouds == Clouds::none) {
        const ClearLevel level = clear_level(*air.turbidity, sun, settings.dhi_w_m2);
        sky.efficacy_lm_w = level.efficacy_lm_w;
        illuminance_lx = level.illuminance_lx;
    } else if (settings.dhi_w_m2) {
        illuminance_lx = *settings.dhi_w_m2 * kOvercastEfficacy;
    } else {
        illuminance_lx =
            air.clouds == Clouds::overcast ? overcast_illuminance(sun.elevation_rad) : broken_illuminance(sun);
    }
    if (!settings.dhi_w_m2) illuminance_lx = std::max(illuminance_lx, dusk_illuminance(sun));
    sky.colour = sky_colour(clear_turbidity(settings), sun.direction, air.clear_share);
    return settings.zenith_cd_m2 ? with_zenith(sky, *settings.zenith_cd_m2) : scaled_to(sky, illuminance_lx);
}

SkyModel model_of(const NoSkySettings&, const SeenSun&, double) {
    return NoSky{};
}
SkyModel model_of(const UniformSkySettings& settings, const SeenSun&, double) {
    return UniformSky{static_cast<float>(settings.luminance_cd_m2)};
}
SkyModel model_of(const PreethamSettings& settings, const SeenSun& sun, double) {
    std::optional<double> dhi;
    if (settings.level == SkyLevel::dhi) dhi = settings.dhi_w_m2;
    const ClearLevel level = clear_level(settings.turbidity, sun, dhi);
    PreethamSky sky = preetham_sky(settings.turbidity, sun.direction);
    const double dusk = dusk_illuminance(sun);
    switch (settings.level) {
        case SkyLevel::clearsky:
            sky = scaled_to(sky, std::max(level.illuminance_lx, dusk));
            break;
        case SkyLevel::published:
            sky.luminance.scale *= dusk / twilight_illuminance(0.0);
            break;
        case SkyLevel::dhi:
            sky = scaled_to(sky, level.illuminance_lx);
            break;
    }
    sky.efficacy_lm_w = level.efficacy_lm_w;
    return sky;
}
SkyModel model_of(const PerezSettings& settings, const SeenSun& sun, double) {
    return perez_sky({settings.dni_w_m2, settings.dhi_w_m2, sun.distance_au, settings.precipitable_water_cm},
                     sun.direction);
}
SkyModel model_of(const CieSettings& settings, const SeenSun& sun, double) {
    return with_level(cie_general_sky(settings.type, sun.direction), settings, air_of(settings), sun);
}
SkyModel model_of(const Cie1994Settings& settings, const SeenSun& sun, double) {
    Cie1994Sky sky = with_level(cie_1994_sky(settings.type, sun.direction), settings, air_of(settings), sun);
    if (settings.level != Cie1994Level::gensky) return sky;
    return with_zenith(
        sky, gensky_zenith_luminance(settings.type, sun.elevation_rad, settings.turbidity.value_or(kGenskyTurbidity)));
}
SkyModel model_of(const ImageSettings& settings, const SeenSun&, double convergence_rad) {
    SKYBAKE_CHECK(settings.image != nullptr);
    return ImageSky{settings.image, settings.rotation_rad - convergence_rad};
}

Beam clear_beam(double turbidity, const SeenSun& sun) {
    return {sun_normal_illuminance(turbidity, sun.zenith_rad(), sun.distance_au),
            clear_sky_irradiance(turbidity, sun.zenith_rad(), sun.distance_au).dni};
}

/// The colour of a clear beam with another illuminance.
Xyz tinted_beam(double turbidity, const SeenSun& sun, double illuminance_lx) {
    const Xyz clear = sun_normal_illuminance(turbidity, sun.zenith_rad(), sun.distance_au);
    return clear.y > 0.0 ? clear * (illuminance_lx / clear.y) : Xyz(0.0);
}

/// Models that have no beam of their own: that of a clear sky.
template <typename Settings>
Beam beam_of(const Settings& settings, const SeenSun& sun) {
    return clear_beam(settings.turbidity, sun);
}
Beam beam_of(const PerezSettings& settings, const SeenSun& sun) {
    if (sun.elevation_rad <= 0.0) return {};
    const PerezState state = perez_state(
        {settings.dni_w_m2, settings.dhi_w_m2, sun.distance_au, settings.precipitable_water_cm}, sun.zenith_rad());
    return {tinted_beam(state.turbidity, sun, settings.dni_w_m2 * state.direct_efficacy_lm_w), settings.dni_w_m2};
}
/// A sun behind thin clouds is dimmed as by haze, but not reddened.
Beam veiled_beam(const CieAir& air, const SeenSun& sun) {
    if (!air.turbidity) return {};
    Beam beam = clear_beam(*air.turbidity, sun);
    if (air.clouds == Clouds::broken)
        beam.normal_illuminance =
            tinted_beam(std::min(*air.turbidity, kDefaultTurbidity), sun, beam.normal_illuminance.y);
    return beam;
}
Beam beam_of(const CieSettings& settings, const SeenSun& sun) {
    return veiled_beam(air_of(settings), sun);
}
Beam beam_of(const Cie1994Settings& settings, const SeenSun& sun) {
    Beam beam = veiled_beam(air_of(settings), sun);
    if (settings.level != Cie1994Level::gensky || !(beam.normal_illuminance.y > 0.0)) return beam;
    const double factor = gensky_sun_illuminance(settings.type, sun.elevation_rad) / beam.normal_illuminance.y;
    return {beam.normal_illuminance * factor, beam.dni_w_m2 * factor};
}
Beam beam_of(const ImageSettings& settings, const SeenSun& sun) {
    return settings.sun == SunInImage::cut ? clear_beam(settings.turbidity, sun) : Beam{};
}

/// Models whose turbidity is a number of their own.
template <typename Settings>
double air_turbidity_of(const Settings& settings, const SeenSun&) {
    return settings.turbidity;
}
double air_turbidity_of(const PerezSettings& settings, const SeenSun& sun) {
    return perez_state({settings.dni_w_m2, settings.dhi_w_m2, sun.distance_au, settings.precipitable_water_cm},
                       sun.zenith_rad())
        .turbidity;
}
double air_turbidity_of(const CieSettings& settings, const SeenSun&) {
    return clear_turbidity(settings);
}
double air_turbidity_of(const Cie1994Settings& settings, const SeenSun&) {
    return clear_turbidity(settings);
}

}  // namespace

SkyModel sky_model(const SkySettings& settings, const SeenSun& sun, double convergence_rad) {
    return std::visit([&](const auto& s) { return model_of(s, sun, convergence_rad); }, settings);
}

Beam sun_beam(const SkySettings& settings, const SeenSun& sun) {
    return std::visit([&](const auto& s) { return beam_of(s, sun); }, settings);
}

double air_turbidity(const SkySettings& settings, const SeenSun& sun) {
    return std::visit([&](const auto& s) { return air_turbidity_of(s, sun); }, settings);
}

std::shared_ptr<const SkyImage> prepared_image(const ImageSettings& settings, SkyImage image, FindingLog& findings) {
    if (settings.sun == SunInImage::cut && !cut_sun(image)) {
        findings.add({"SB606", Severity::warning, settings.file,
                      "there is no sun in the picture to cut: nothing in it is twice as bright as what is around it.",
                      "Take sun=keep."});
    }
    if (settings.dhi_w_m2) {
        const double illuminance = luminance(Rgb(horizontal_illuminance(image)));
        if (illuminance > 0.0) image = scaled(std::move(image), *settings.dhi_w_m2 * kOvercastEfficacy / illuminance);
    }
    return std::make_shared<const SkyImage>(std::move(image));
}

}  // namespace skybake
