#include "sky/sky_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/nearest_word.h"
#include "sky/text_numbers.h"

namespace skybake {

namespace {

constexpr double kMostIrradiance = 1500.0;  // W m⁻²: more than the sun gives outside the atmosphere
constexpr double kMostLuminance = 1e9;      // cd m⁻²

/// The k=v pairs behind a sky's name.
class SkyOptions {
  public:
    SkyOptions(std::string_view whole, std::string_view options) : whole_(whole) {
        while (!options.empty()) {
            const std::size_t comma = options.find(',');
            const std::string_view option = options.substr(0, comma);
            const std::size_t equals = option.find('=');
            if (equals == std::string_view::npos) refuse(fmt::format("'{}' is not KEY=VALUE", option));
            const std::string key(option.substr(0, equals));
            if (find(key)) refuse(fmt::format("'{}' is given twice", key));
            pairs_.emplace_back(key, option.substr(equals + 1));
            if (comma == std::string_view::npos) break;
            options.remove_prefix(comma + 1);
            if (options.empty()) refuse("it ends in a comma");
        }
    }
    void allow(const std::vector<std::string>& known) const {
        for (const auto& [key, value] : pairs_) {
            if (std::find(known.begin(), known.end(), key) != known.end()) continue;
            refuse(fmt::format("there is no key '{}'; did you mean '{}'? Known keys: {}", key, nearest_word(key, known),
                               fmt::join(known, ", ")));
        }
    }
    std::optional<std::string_view> find(std::string_view key) const {
        for (const auto& [k, value] : pairs_) {
            if (k == key) return value;
        }
        return std::nullopt;
    }
    /// The number of a key that may be absent.
    std::optional<double> optional_number(std::string_view key, double low, double high, const char* unit) const {
        const auto text = find(key);
        return text ? std::optional(checked_number(key, *text, low, high, unit)) : std::nullopt;
    }
    /// The number of a key that must be there.
    double required_number(std::string_view key, double low, double high, const char* unit, const char* remedy) const {
        const auto text = find(key);
        if (!text) refuse(fmt::format("{} is missing. {}", key, remedy));
        return checked_number(key, *text, low, high, unit);
    }
    double number(std::string_view key, double low, double high, double otherwise, const char* unit) const {
        const auto text = find(key);
        return text ? checked_number(key, *text, low, high, unit) : otherwise;
    }
    double checked_number(std::string_view key, std::string_view text, double low, double high,
                          const char* unit) const {
        const auto value = number_of(text);
        if (!value || *value < low || *value > high) {
            refuse(fmt::format("{}={} is not a number in {:g}…{:g}{}", key, text, low, high, unit));
        }
        return *value;
    }
    [[noreturn]] void refuse(const std::string& why) const {
        throw InputError(fmt::format("--sky '{}': {}.", whole_, why));
    }

  private:
    std::string_view whole_;
    std::vector<std::pair<std::string, std::string_view>> pairs_;
};

double turbidity_of(const SkyOptions& options) {
    return options.number("turbidity", 1.0, 60.0, kDefaultTurbidity, "");
}

PreethamSettings preetham_settings(const SkyOptions& options) {
    options.allow({"turbidity", "level", "dhi"});
    PreethamSettings settings;
    settings.turbidity = turbidity_of(options);
    // "level=dhi=150" and plain "dhi=150" mean the same.
    std::optional<std::string_view> dhi = options.find("dhi");
    if (const auto level = options.find("level")) {
        if (dhi) options.refuse("level and dhi exclude each other");
        if (level->starts_with("dhi=")) {
            dhi = level->substr(4);
        } else if (*level == "published") {
            settings.level = SkyLevel::published;
        } else if (*level != "clearsky") {
            options.refuse(fmt::format("there is no level '{}'; known levels: clearsky, published, dhi=W", *level));
        }
    }
    if (dhi) {
        settings.level = SkyLevel::dhi;
        settings.dhi_w_m2 = options.checked_number("dhi", *dhi, 0.0, 1500.0, " W/m²");
    }
    return settings;
}

std::optional<double> turbidity_in(const SkyOptions& options) {
    return options.optional_number("turbidity", 1.0, 60.0, "");
}

std::optional<double> dhi_in(const SkyOptions& options) {
    return options.optional_number("dhi", 0.0, kMostIrradiance, " W/m²");
}

std::optional<double> zenith_in(const SkyOptions& options) {
    const auto zenith = options.optional_number("zenith", 0.0, kMostLuminance, " cd/m²");
    if (zenith && options.find("dhi")) options.refuse("dhi and zenith exclude each other");
    return zenith;
}

PerezSettings perez_settings(const SkyOptions& options) {
    options.allow({"dni", "dhi", "water"});
    constexpr const char* kRemedy =
        "The Perez sky is made from a measured weather: --sky perez:dni=W,dhi=W, for example perez:dni=700,dhi=100";
    PerezSettings settings;
    settings.dni_w_m2 = options.required_number("dni", 0.0, kMostIrradiance, " W/m²", kRemedy);
    settings.dhi_w_m2 = options.required_number("dhi", 0.0, kMostIrradiance, " W/m²", kRemedy);
    settings.precipitable_water_cm = options.number("water", 0.0, 10.0, settings.precipitable_water_cm, " cm");
    return settings;
}

/// The turbidity is that of the beam and of the blue: a sky without sun has neither.
void refuse_turbidity(const SkyOptions& options) {
    if (options.find("turbidity"))
        options.refuse("this sky hides the sun and has no blue: turbidity says nothing of it");
}

CieSettings cie_settings(const SkyOptions& options) {
    options.allow({"type", "dhi", "zenith", "turbidity"});
    const double type = options.required_number(
        "type", 1.0, 15.0, "",
        "The CIE general sky has 15 types, for example cie:type=1 (overcast) or cie:type=12 (clear)");
    if (type != std::floor(type)) options.refuse(fmt::format("type={} is not a whole number in 1…15", type));
    if (type <= 6.0) refuse_turbidity(options);
    return {static_cast<int>(type), dhi_in(options), zenith_in(options), turbidity_in(options)};
}

const std::vector<std::string>& cie_1994_names() {
    static const std::vector<std::string> names = {"clear", "turbid", "intermediate", "overcast"};
    return names;
}

Cie1994Settings cie_1994_settings(const std::string& name, const SkyOptions& options) {
    const std::vector<std::string>& names = cie_1994_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        options.refuse(name.empty() ? std::string("which one? It is cie1994:clear, turbid, intermediate or overcast")
                                    : fmt::format("there is no sky '{}' of 1994; did you mean '{}'? Known skies: {}",
                                                  name, nearest_word(name, names), fmt::join(names, ", ")));
    }
    const auto type = static_cast<Cie1994Type>(found - names.begin());
    options.allow({"dhi", "zenith", "level", "turbidity"});
    if (type == Cie1994Type::overcast) refuse_turbidity(options);
    Cie1994Settings settings{type, dhi_in(options), zenith_in(options), turbidity_in(options)};
    if (const auto level = options.find("level")) {
        if (*level != "gensky") options.refuse(fmt::format("there is no level '{}'; known levels: gensky", *level));
        if (settings.dhi_w_m2 || settings.zenith_cd_m2) options.refuse("level excludes dhi and zenith");
        settings.level = Cie1994Level::gensky;
    }
    return settings;
}

ImageSettings image_settings(const std::string& file, const SkyOptions& options) {
    if (file.empty()) options.refuse("the file is missing. It is image:FILE, an equirectangular .exr or .hdr");
    options.allow({"sun", "rotate", "scale", "dhi", "turbidity"});
    ImageSettings settings;
    settings.file = file;
    if (const auto sun = options.find("sun")) {
        if (*sun != "keep" && *sun != "cut") options.refuse(fmt::format("sun={} is neither keep nor cut", *sun));
        settings.sun = *sun == "cut" ? SunInImage::cut : SunInImage::keep;
    }
    settings.rotation_rad = radians_from_degrees(options.number("rotate", -360.0, 360.0, 0.0, "°"));
    settings.scale = options.optional_number("scale", 0.0, kMostLuminance, "");
    settings.dhi_w_m2 = dhi_in(options);
    if (settings.scale && settings.dhi_w_m2) options.refuse("scale and dhi exclude each other");
    settings.turbidity = turbidity_of(options);
    return settings;
}

std::string text_of(const PreethamSettings& sky) {
    const std::string level = sky.level == SkyLevel::clearsky    ? "clearsky"
                              : sky.level == SkyLevel::published ? "published"
                                                                 : fmt::format("dhi={}", sky.dhi_w_m2);
    return fmt::format("preetham:turbidity={},level={}", sky.turbidity, level);
}
std::string text_of(const UniformSkySettings& sky) {
    return fmt::format("uniform:luminance={},turbidity={}", sky.luminance_cd_m2, sky.turbidity);
}
std::string text_of(const NoSkySettings& sky) {
    return fmt::format("none:turbidity={}", sky.turbidity);
}
std::string text_of(const PerezSettings& sky) {
    return fmt::format("perez:dni={},dhi={},water={}", sky.dni_w_m2, sky.dhi_w_m2, sky.precipitable_water_cm);
}
/// ",dhi=…", ",zenith=…" and ",turbidity=…" as far as they are given.
template <typename Cie>
std::string level_text(const Cie& sky) {
    std::string text;
    if (sky.dhi_w_m2) text += fmt::format(",dhi={}", *sky.dhi_w_m2);
    if (sky.zenith_cd_m2) text += fmt::format(",zenith={}", *sky.zenith_cd_m2);
    if (sky.turbidity) text += fmt::format(",turbidity={}", *sky.turbidity);
    return text;
}
std::string text_of(const CieSettings& sky) {
    return fmt::format("cie:type={}{}", sky.type, level_text(sky));
}
std::string text_of(const Cie1994Settings& sky) {
    return fmt::format("cie1994:{}{}{}", cie_1994_names()[static_cast<std::size_t>(sky.type)], level_text(sky),
                       sky.level == Cie1994Level::gensky ? ",level=gensky" : "");
}
std::string text_of(const ImageSettings& sky) {
    std::string text = fmt::format("image:{},sun={},rotate={:.6g}", sky.file,
                                   sky.sun == SunInImage::cut ? "cut" : "keep", degrees_from_radians(sky.rotation_rad));
    if (sky.scale) text += fmt::format(",scale={}", *sky.scale);
    if (sky.dhi_w_m2) text += fmt::format(",dhi={}", *sky.dhi_w_m2);
    return text + fmt::format(",turbidity={}", sky.turbidity);
}

}  // namespace

SkySettings parse_sky(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string model(text.substr(0, colon));
    std::string_view rest = colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
    // The first word of these is no key: a name, or a file.
    std::string subject;
    if (model == "cie1994" || model == "image") {
        const std::size_t comma = rest.find(',');
        subject = std::string(rest.substr(0, comma));
        rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    }
    const SkyOptions options(text, rest);
    if (model == "preetham") return preetham_settings(options);
    if (model == "perez") return perez_settings(options);
    if (model == "cie") return cie_settings(options);
    if (model == "cie1994") return cie_1994_settings(subject, options);
    if (model == "image") return image_settings(subject, options);
    if (model == "uniform") {
        options.allow({"luminance", "turbidity"});
        return UniformSkySettings{
            options.number("luminance", 0.0, kMostLuminance, UniformSkySettings{}.luminance_cd_m2, " cd/m²"),
            turbidity_of(options)};
    }
    if (model == "none") {
        options.allow({"turbidity"});
        return NoSkySettings{turbidity_of(options)};
    }
    const std::vector<std::string> known = {"preetham", "perez", "cie", "cie1994", "image", "uniform", "none"};
    options.refuse(fmt::format("there is no sky model '{}'; did you mean '{}'? Available are {}", model,
                               nearest_word(model, known), kSkyForms));
}

std::string to_text(const SkySettings& sky) {
    return std::visit([](const auto& settings) { return text_of(settings); }, sky);
}

bool needs_sun(const SkySettings& sky) {
    // The standard overcast skies and the uniform one only take their level from the sun's height.
    if (const auto* cie = std::get_if<CieSettings>(&sky)) {
        const bool is_round = cie->type == 1 || cie->type == 3 || cie->type == 5;
        return !(is_round && (cie->dhi_w_m2 || cie->zenith_cd_m2));
    }
    if (const auto* cie = std::get_if<Cie1994Settings>(&sky))
        return !(cie->type == Cie1994Type::overcast && (cie->dhi_w_m2 || cie->zenith_cd_m2));
    return std::holds_alternative<PreethamSettings>(sky) || std::holds_alternative<PerezSettings>(sky);
}

}  // namespace skybake
