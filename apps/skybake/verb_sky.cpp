// skybake sky: luminance and colour of the sky in asked directions, as a panorama, and summed up.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <span>

#include "base/error.h"
#include "base/nearest_word.h"
#include "base/threads.h"
#include "io/exr/exr.h"
#include "io/image/image.h"
#include "light_options.h"
#include "program.h"
#include "sky/sky_panorama.h"
#include "sky/solar_position.h"
#include "weather_option.h"

namespace skybake::cli {

namespace {

struct SkyVerbOptions {
    LightOptions light;
    std::string directions;
    std::string picture;
    std::string projection = "equirectangular";
    std::optional<int> width;
};

struct Query {
    std::string azimuth;    // as in the file
    std::string elevation;  // as in the file
    std::string rest;       // further columns, with their commas in front
    Vec3d direction{0.0, 0.0, 1.0};
};

struct Queries {
    std::string rest_header;
    std::vector<Query> list;
};

/// The fields of one CSV line, quotes kept.
std::vector<std::string> csv_fields(const std::string& line) {
    std::vector<std::string> fields(1);
    bool is_quoted = false;
    for (const char c : line) {
        if (c == '"') is_quoted = !is_quoted;
        if (c == ',' && !is_quoted) {
            fields.emplace_back();
        } else if (c != '\r') {
            fields.back() += c;
        }
    }
    return fields;
}

std::string trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t' || text.front() == '"')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '"')) text.remove_suffix(1);
    return std::string(text);
}

double angle_of(const std::string& field, double low, double high, const std::string& where, const char* column) {
    double degrees = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), degrees);
    if (error != std::errc{} || end != field.data() + field.size() || !(degrees >= low && degrees <= high)) {
        throw InputError(fmt::format("{}: {} is '{}', not a number in {:g}…{:g}.", where, column, field, low, high));
    }
    return degrees;
}

Queries read_directions(const std::string& path) {
    std::ifstream file;
    if (path != "-") {
        file.open(path);
        if (!file || std::filesystem::is_directory(path))
            throw InputError(fmt::format("{}: cannot be read. --directions is a CSV file, or - for stdin.", path));
    }
    std::istream& in = path == "-" ? std::cin : file;
    std::string line;
    std::getline(in, line);
    if (line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
    const std::vector<std::string> header = csv_fields(line);
    const auto column_of = [&](const char* name) {
        for (std::size_t i = 0; i < header.size(); ++i) {
            if (trimmed(header[i]) == name) return i;
        }
        throw InputError(fmt::format(
            "{}:1: there is no column {}. The first line is a header such as azimuth_deg,elevation_deg.", path, name));
    };
    const std::size_t azimuth = column_of("azimuth_deg");
    const std::size_t elevation = column_of("elevation_deg");
    const auto rest_of = [&](const std::vector<std::string>& fields) {
        std::string rest;
        for (std::size_t i = 0; i < header.size(); ++i) {
            if (i != azimuth && i != elevation) rest += "," + fields[i];
        }
        return rest;
    };

    Queries queries;
    queries.rest_header = rest_of(header);
    for (std::size_t number = 2; std::getline(in, line); ++number) {
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        std::vector<std::string> fields = csv_fields(line);
        const std::string where = fmt::format("{}:{}", path, number);
        if (fields.size() != header.size()) {
            throw InputError(fmt::format("{}: {} fields, but the header has {}. Repair the line.", where, fields.size(),
                                         header.size()));
        }
        Query query{trimmed(fields[azimuth]), trimmed(fields[elevation]), rest_of(fields), {}};
        const double azimuth_deg = angle_of(query.azimuth, -360.0, 360.0, where, "azimuth_deg");
        const double elevation_deg = angle_of(query.elevation, -90.0, 90.0, where, "elevation_deg");
        query.direction = world_direction(radians_from_degrees(azimuth_deg), radians_from_degrees(elevation_deg), 0.0);
        queries.list.push_back(std::move(query));
    }
    if (in.bad()) throw InputError(fmt::format("{}: reading failed.", path));
    return queries;
}

/// CIE 1931 x and y; nothing for black, which has no colour.
std::optional<Vec2d> chromaticity(const Xyz& xyz) {
    const double sum = xyz.x + xyz.y + xyz.z;
    if (!(sum > 0.0)) return std::nullopt;
    return Vec2d(xyz.x / sum, xyz.y / sum);
}

void print_csv(const SkyModel& sky, const Queries& queries) {
    fmt::print("azimuth_deg,elevation_deg,luminance_cd_m2,r,g,b,x,y{}\n", queries.rest_header);
    for (const Query& query : queries.list) {
        const Xyz xyz = sky_xyz(sky, query.direction);
        const Rgb rgb = rgb_from_xyz(xyz);
        const auto xy = chromaticity(xyz);
        fmt::print("{},{},{:.9g},{:.7g},{:.7g},{:.7g},{},{}{}\n", query.azimuth, query.elevation, xyz.y, rgb.x, rgb.y,
                   rgb.z, xy ? fmt::format("{:.9g}", xy->x) : "", xy ? fmt::format("{:.9g}", xy->y) : "", query.rest);
    }
}

nlohmann::json directions_json(const SkyModel& sky, const Queries& queries) {
    nlohmann::json list = nlohmann::json::array();
    for (const Query& query : queries.list) {
        const Xyz xyz = sky_xyz(sky, query.direction);
        const Rgb rgb = rgb_from_xyz(xyz);
        const auto xy = chromaticity(xyz);
        nlohmann::json entry = {{"azimuth_deg", std::stod(query.azimuth)},
                                {"elevation_deg", std::stod(query.elevation)},
                                {"luminance_cd_m2", xyz.y},
                                {"r", rgb.x},
                                {"g", rgb.y},
                                {"b", rgb.z},
                                {"x", nullptr},
                                {"y", nullptr}};
        if (xy) {
            entry["x"] = xy->x;
            entry["y"] = xy->y;
        }
        list.push_back(std::move(entry));
    }
    return list;
}

/// The pictures side by side; of an equirectangular one only the upper half, one above the other, so that the days'
/// horizons line up.
io::PictureRgb strip(std::vector<io::PictureRgb> pictures, bool is_side_by_side) {
    const int width = pictures.front().width;
    const int height = is_side_by_side ? pictures.front().height : pictures.front().height / 2;
    const int count = static_cast<int>(pictures.size());
    io::PictureRgb whole{is_side_by_side ? count * width : width, is_side_by_side ? height : count * height, {}};
    whole.pixels.reserve(static_cast<std::size_t>(whole.width) * static_cast<std::size_t>(whole.height));
    for (int row = 0; row < whole.height; ++row) {
        for (int i = 0; i < (is_side_by_side ? count : 1); ++i) {
            const io::PictureRgb& picture = pictures[static_cast<std::size_t>(is_side_by_side ? i : row / height)];
            const auto begin = picture.pixels.begin() + static_cast<std::ptrdiff_t>(row % height) * width;
            whole.pixels.insert(whole.pixels.end(), begin, begin + width);
        }
    }
    return whole;
}

/// The logarithmic mean of the sky's luminance, of an equirectangular picture the upper half's, where it is not black;
/// nothing for a black sky.
std::optional<double> log_average(const io::PictureRgb& picture) {
    double log_sum = 0.0;
    std::size_t lit = 0;
    const bool has_land = picture.width == 2 * picture.height;
    for (const Rgb& pixel : std::span(picture.pixels).first(picture.pixels.size() / (has_land ? 2 : 1))) {
        const double value = luminance(pixel);
        if (!(value > 0.0)) continue;
        log_sum += std::log(value);
        ++lit;
    }
    return lit > 0 ? std::optional(std::exp(log_sum / static_cast<double>(lit))) : std::nullopt;
}

/// Based on: Reinhard et al., "Photographic tone reproduction for digital images", SIGGRAPH 2002, equation 4: `average`
/// becomes middle grey, and what is sixteen times as bright white. Works on luminance, so that the hue stays; a colour
/// too strong for the screen fades towards the grey of its luminance, which keeps sunsets orange where cutting the
/// channels makes them green.
io::Image8 tone_mapped(const io::PictureRgb& picture, std::optional<double> average) {
    io::Image8 image{picture.width, picture.height, 3, std::vector<std::uint8_t>(3 * picture.pixels.size())};
    if (!average) return image;
    constexpr double kMiddleGrey = 0.3;  // by eye: a clear noon sky looks like one on a screen; 0.18 is dull
    const double exposure = kMiddleGrey / *average;
    constexpr double kWhite = 16.0 * kMiddleGrey;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const Rgb& pixel = picture.pixels[i];
        const double scaled = exposure * luminance(pixel);
        const double shown = (1.0 + scaled / (kWhite * kWhite)) / (1.0 + scaled) * exposure;
        Rgb display = pixel * static_cast<float>(shown);
        const float grey = luminance(display);
        const float strongest = std::max({display.x, display.y, display.z});
        if (grey >= 1.0f) {
            display = Rgb(1.0f);
        } else if (strongest > 1.0f) {
            display = Rgb(grey) + (display - Rgb(grey)) * ((1.0f - grey) / (strongest - grey));
        }
        for (int channel = 0; channel < 3; ++channel) {
            image.pixels[3 * i + static_cast<std::size_t>(channel)] =
                static_cast<std::uint8_t>(std::lround(255.0f * srgb_from_linear(display[channel])));
        }
    }
    return image;
}

/// Panorama of one instant, or a strip of several. Returns what it shows, for the user.
std::string write_picture(const SkyVerbOptions& options, std::span<const Daylight> daylights,
                          const DaylightSettings& settings) {
    const bool is_fisheye = options.projection == "fisheye";
    const bool is_strip = daylights.size() > 1;
    const int width = options.width.value_or(is_strip ? (is_fisheye ? 256 : 1024) : (is_fisheye ? 1024 : 2048));
    std::vector<io::PictureRgb> pictures;
    std::string instants;
    std::optional<double> average;  // of the brightest sky: a day's strip is exposed for the day, not for its dusk
    for (const Daylight& daylight : daylights) {
        pictures.push_back({width, is_fisheye ? width : width / 2, {}});
        pictures.back().pixels = is_fisheye ? fisheye(daylight, width) : equirectangular(daylight, width);
        average = std::max(average, log_average(pictures.back()));
        instants += (instants.empty() ? "" : ", ") + daylight.label;
    }
    const io::PictureRgb picture = is_strip ? strip(std::move(pictures), is_fisheye) : std::move(pictures.front());
    const std::filesystem::path path = options.picture;
    if (path.extension() == ".png") {
        io::write_png(path, tone_mapped(picture, average));
    } else {
        io::write_exr_rgb(
            path, picture,
            {{"skybake.sky", to_text(settings.sky)},
             {"skybake.instant", instants},
             {"skybake.projection", options.projection},
             {"skybake.sun", settings.sun == SunShape::none ? "left out" : "in the picture, where it has a beam"},
             {"skybake.unit", "cd/m2 per channel, linear Rec. 709"}});
    }
    const std::string one = is_fisheye ? "fisheye, equidistant, north on top, east on the left, zenith in the middle"
                                       : "equirectangular, zenith on top, true north at the left edge, clockwise";
    const std::string many =
        is_fisheye ? fmt::format("{} skies from left to right, each ", daylights.size())
                   : fmt::format("{} skies from top to bottom down to the horizon, each ", daylights.size());
    return fmt::format("wrote {}: {} x {}, {}{}", options.picture, picture.width, picture.height, is_strip ? many : "",
                       one);
}

nlohmann::json summary_of(const Daylight& daylight, const SkySettings& settings) {
    const HorizontalDiffuse diffuse = horizontal_diffuse(daylight.sky);
    const double sine = std::max(0.0, static_cast<double>(daylight.sun.direction.z));
    const bool has_sun = daylight.sun.shape != SunShape::none;
    nlohmann::json object = {
        {"instant", daylight.label},
        {"sky", to_text(settings)},
        {"zenith_luminance_cd_m2", sky_xyz(daylight.sky, {0.0, 0.0, 1.0}).y},
        {"diffuse_horizontal_lx", luminance(diffuse.illuminance)},
        {"diffuse_horizontal_rgb", {diffuse.illuminance.x, diffuse.illuminance.y, diffuse.illuminance.z}},
        {"dhi_w_m2", diffuse.irradiance_w_m2},
        {"dni_w_m2", daylight.sun.dni_w_m2},
        {"direct_normal_lx", luminance(daylight.sun.normal_illuminance)},
        {"global_horizontal_lx", luminance(diffuse.illuminance) + sine * luminance(daylight.sun.normal_illuminance)},
        {"ghi_w_m2", diffuse.irradiance_w_m2 + sine * daylight.sun.dni_w_m2},
        {"sun_azimuth_deg", nullptr},
        {"sun_apparent_elevation_deg", nullptr}};
    if (has_sun) {
        const Vec3d sun(daylight.sun.direction);
        const double azimuth = degrees_from_radians(std::atan2(sun.x, sun.y));
        object["sun_azimuth_deg"] = azimuth < 0.0 ? azimuth + 360.0 : azimuth;
        object["sun_apparent_elevation_deg"] = degrees_from_radians(std::atan2(sun.z, std::hypot(sun.x, sun.y)));
    }
    return object;
}

void print_summary(const nlohmann::json& summary) {
    const auto row = [&](const char* name, const char* key, const char* unit) {
        if (!summary[key].is_null()) fmt::print("{:<28} {:>12.2f} {}\n", name, summary[key].get<double>(), unit);
    };
    fmt::print("{}, {}\n", summary["instant"].get<std::string>(), summary["sky"].get<std::string>());
    row("sun's azimuth", "sun_azimuth_deg", "deg");
    row("sun's apparent elevation", "sun_apparent_elevation_deg", "deg");
    row("zenith luminance", "zenith_luminance_cd_m2", "cd/m2");
    row("diffuse horizontal", "diffuse_horizontal_lx", "lx");
    row("diffuse horizontal", "dhi_w_m2", "W/m2");
    row("direct normal", "direct_normal_lx", "lx");
    row("direct normal", "dni_w_m2", "W/m2");
    row("global horizontal", "global_horizontal_lx", "lx");
    row("global horizontal", "ghi_w_m2", "W/m2");
}

/// --weather without --at: what the file holds.
int run_weather(const DaylightSettings& settings, const SkyVerbOptions& options, const CommonOptions& common) {
    if (!options.picture.empty() || !options.directions.empty())
        throw InputError(
            "--weather needs the hour of the sky: give --at TIME, for example --at 2026-06-21T12:00+02:00.");
    if (common.wants_json) {
        nlohmann::json object = {{"weather", weather_json(*settings.weather)}};
        object["findings"] = to_json(settings.weather_findings);
        print_json(object);
    } else {
        print_weather(*settings.weather);
    }
    return report_findings(common, settings.weather_findings);
}

int run_sky(const SkyVerbOptions& options, const CommonOptions& common) {
    if (!options.picture.empty()) {
        const std::string extension = std::filesystem::path(options.picture).extension().string();
        if (extension != ".png" && extension != ".exr")
            throw InputError(fmt::format("-o {}: the panorama is a .png or an .exr.", options.picture));
    }
    const std::vector<std::string> projections = {"equirectangular", "fisheye"};
    if (std::find(projections.begin(), projections.end(), options.projection) == projections.end()) {
        throw InputError(fmt::format("--projection '{}' is unknown; did you mean '{}'? Known: {}", options.projection,
                                     nearest_word(options.projection, projections), fmt::join(projections, ", ")));
    }
    const ThreadLimit threads(common.threads);
    FindingLog findings;
    const DaylightSettings settings = daylight_settings_of(options.light);
    if (settings.weather && settings.instants.empty()) return run_weather(settings, options, common);
    const std::vector<Daylight> daylights =
        make_daylights(settings, site_of(options.light, std::nullopt), 0.0, findings);
    std::optional<Queries> queries;
    if (!options.directions.empty()) {
        if (daylights.size() > 1) {
            throw InputError(fmt::format("--at names {} instants; --directions answers for one. Call it once for each.",
                                         daylights.size()));
        }
        queries = read_directions(options.directions);
    }
    if (!options.picture.empty()) say(common, write_picture(options, daylights, settings));
    if (common.wants_json) {
        std::vector<nlohmann::json> entries;
        for (std::size_t i = 0; i < daylights.size(); ++i)
            entries.push_back(summary_of(daylights[i], sky_at(settings, i)));
        nlohmann::json object = entries.size() == 1 ? entries.front() : nlohmann::json::object();
        object["instants"] = entries;
        if (settings.weather) object["weather"] = weather_json(*settings.weather);
        if (queries) object["directions"] = directions_json(daylights.front().sky, *queries);
        object["findings"] = to_json(findings);
        print_json(object);
    } else if (queries) {
        print_csv(daylights.front().sky, *queries);
    } else if (options.picture.empty()) {
        for (std::size_t i = 0; i < daylights.size(); ++i) print_summary(summary_of(daylights[i], sky_at(settings, i)));
    }
    return report_findings(common, findings);
}

}  // namespace

void add_sky(CLI::App& app, Program& program) {
    const auto options = std::make_shared<SkyVerbOptions>();
    CLI::App* verb = add_verb(
        app, program, "sky", "Luminance and colour of the sky: summed up, in given directions, or as pictures.",
        "  skybake sky --sun-direction 180,45 --sky perez:dni=700,dhi=90\n"
        "  skybake sky --site 47.07,15.44 --at 2026-06-21T12:00+02:00 --projection fisheye -o sky.png\n"
        "  skybake sky --site 47.07,15.44 --at 2026-06-21T04:00Z/2026-06-21T20:00Z/2h -o day.png\n"
        "  skybake sky --sun-direction 180,45 --sky cie:type=12 --directions directions.csv\n"
        "  skybake sky --weather graz.epw --at 2026-06-21T12:00+02:00",
        [options, &program] { return run_sky(*options, program.common); });
    add_daylight_options(verb, options->light);
    verb->add_option("--sun", options->light.sun,
                     "none leaves the sun's disc, and its light on the land, out of pictures")
        ->group("Light")
        ->type_name("SHAPE")
        ->capture_default_str();
    verb->add_option("--directions", options->directions,
                     "CSV with azimuth_deg,elevation_deg; answers as CSV on stdout; - is stdin")
        ->type_name("CSV");
    verb->add_option("-o,--output", options->picture,
                     "panorama, or a strip of several instants: .png (tone mapped) or .exr (cd/m2 per channel)")
        ->type_name("FILE");
    verb->add_option("--projection", options->projection,
                     "equirectangular (whole sphere, with land of albedo 0.2) or fisheye (the dome)")
        ->type_name("NAME")
        ->capture_default_str();
    verb->add_option("--width", options->width,
                     "pixels; default 2048, fisheye 1024, in strips 1024 and 256; equirectangular is half as high")
        ->check(CLI::Range(2, 16384));
}

}  // namespace skybake::cli
