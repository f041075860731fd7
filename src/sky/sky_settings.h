// What --sky says: the model and its numbers.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/finding.h"
#include "sky/cie_sky.h"
#include "sky/image_sky.h"

namespace skybake {

/// Where the Preetham sky takes its absolute level from.
enum class SkyLevel {
    clearsky,   // the diffuse irradiance of a clear sky of the same turbidity (sky/clear_sky.h)
    published,  // the paper's own zenith luminance
    dhi         // a diffuse horizontal irradiance that the user gives
};

/// Turbidity of the sun's beam where the sky model has none of its own.
inline constexpr double kDefaultTurbidity = 3.0;

struct NoSkySettings {
    double turbidity = kDefaultTurbidity;  // of the beam only
};
struct UniformSkySettings {
    double luminance_cd_m2 = 1000.0;
    double turbidity = kDefaultTurbidity;  // of the beam only
};
struct PreethamSettings {
    double turbidity = kDefaultTurbidity;
    SkyLevel level = SkyLevel::clearsky;
    double dhi_w_m2 = 0.0;  // for SkyLevel::dhi
};
struct PerezSettings {
    double dni_w_m2 = 0.0;
    double dhi_w_m2 = 0.0;
    double precipitable_water_cm = 2.0;
};

/// The level of a CIE sky: at most one of dhi and zenith; without both, that of the type (sky/sky_level.h).
struct CieSettings {
    int type = 12;
    std::optional<double> dhi_w_m2 = std::nullopt;
    std::optional<double> zenith_cd_m2 = std::nullopt;
    std::optional<double> turbidity = std::nullopt;  // of the beam and the colour; default: that of the type
};
enum class Cie1994Level {
    type,   // the level of the type, or dhi or zenith
    gensky  // zenith and sun as Radiance's gensky has them (sky/gensky_level.h); the turbidity is then gensky's
};
struct Cie1994Settings {
    Cie1994Type type = Cie1994Type::clear;
    std::optional<double> dhi_w_m2 = std::nullopt;
    std::optional<double> zenith_cd_m2 = std::nullopt;
    std::optional<double> turbidity = std::nullopt;
    Cie1994Level level = Cie1994Level::type;
};

enum class SunInImage {
    keep,  // the picture is all the light there is
    cut    // taken out of the picture (cut_sun); the beam is that of a clear sky, if the sun has a place
};
struct ImageSettings {
    std::string file;
    SunInImage sun = SunInImage::keep;
    double rotation_rad = 0.0;                      // true azimuth of the picture's left edge
    std::optional<double> scale = std::nullopt;     // cd m⁻² per unit of the file; default: that of its format
    std::optional<double> dhi_w_m2 = std::nullopt;  // instead of scale: what the sky, without the cut sun, brings
    double turbidity = kDefaultTurbidity;           // of the beam only
    /// The picture as the sky is to be: for whoever reads files to fill in (prepared_image, api/load_sky_image.h).
    std::shared_ptr<const SkyImage> image = nullptr;
    std::vector<Finding> findings = {};  // what reading it found; make_daylights reports them
};
using SkySettings = std::variant<PreethamSettings, UniformSkySettings, NoSkySettings, PerezSettings, CieSettings,
                                 Cie1994Settings, ImageSettings>;

/// The forms of --sky, for help texts and messages.
inline constexpr const char* kSkyForms =
    "preetham:turbidity=T,level=clearsky|published|dhi=W; perez:dni=W,dhi=W; cie:type=1..15,dhi=W|zenith=CD_M2; "
    "cie1994:clear|turbid|intermediate|overcast,dhi=W; image:FILE,sun=keep|cut; uniform:luminance=CD_M2; none";

/// The value of --sky, one of kSkyForms; all but preetham and perez take a turbidity for the beam. Throws InputError
/// for unknown models and keys (naming the nearest), for values out of range, and for what is missing.
SkySettings parse_sky(std::string_view text);
/// The same settings written out whole, as parse_sky reads them: for manifests.
std::string to_text(const SkySettings& sky);

/// Whether the sky's distribution or level hangs on where the sun stands.
bool needs_sun(const SkySettings& sky);

}  // namespace skybake
