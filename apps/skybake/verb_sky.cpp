// skybake sky: luminance and colour of the sky in asked directions, as a panorama, and summed up.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

#include "base/error.h"
#include "io/exr/exr.h"
#include "io/image/image.h"
#include "light_options.h"
#include "program.h"
#include "sky/solar_position.h"
#include "weather_option.h"

namespace skybake::cli {

namespace {

struct SkyOptions {
    LightOptions light;
    std::string directions;
    std::string picture;
    int width = 2048;
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

/// The whole sphere, 2:1: row 0 the zenith, the last row the nadir, columns clockwise from true north; black below the
/// horizon.
io::PictureRgb equirectangular(const SkyModel& sky, int width) {
    io::PictureRgb picture{width, width / 2, {}};
    picture.pixels.reserve(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    for (int row = 0; row < picture.height; ++row) {
        const double elevation = kPi * (0.5 - (row + 0.5) / picture.height);
        for (int column = 0; column < picture.width; ++column) {
            picture.pixels.push_back(
                sky_luminance(sky, Vec3f(world_direction(2.0 * kPi * (column + 0.5) / picture.width, elevation, 0.0))));
        }
    }
    return picture;
}

/// Based on: Reinhard et al., "Photographic tone reproduction for digital images", SIGGRAPH 2002, equation 4: the log
/// average of the sky becomes middle grey, and what is eight times as bright (or the maximum, if less) white. Works on
/// luminance, so that the hue stays.
io::Image8 tone_mapped(const io::PictureRgb& picture) {
    double log_sum = 0.0;
    double brightest = 0.0;
    std::size_t lit = 0;
    for (const Rgb& pixel : picture.pixels) {
        const double value = luminance(pixel);
        if (!(value > 0.0)) continue;
        log_sum += std::log(value);
        brightest = std::max(brightest, value);
        ++lit;
    }
    io::Image8 image{picture.width, picture.height, 3, std::vector<std::uint8_t>(3 * picture.pixels.size())};
    if (lit == 0) return image;
    constexpr double kMiddleGrey = 0.3;  // by eye: a clear noon sky looks like one on a screen; 0.18 is dull
    const double exposure = kMiddleGrey / std::exp(log_sum / static_cast<double>(lit));
    const double white = std::min(8.0 * kMiddleGrey, exposure * brightest);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const Rgb& pixel = picture.pixels[i];
        const double scaled = exposure * luminance(pixel);
        const double shown = (1.0 + scaled / (white * white)) / (1.0 + scaled) * exposure;
        const Rgb display = pixel * static_cast<float>(shown);
        for (int channel = 0; channel < 3; ++channel) {
            image.pixels[3 * i + static_cast<std::size_t>(channel)] =
                static_cast<std::uint8_t>(std::lround(255.0f * srgb_from_linear(display[channel])));
        }
    }
    return image;
}

void write_picture(const std::filesystem::path& path, const Daylight& daylight, const SkySettings& settings,
                   int width) {
    const std::string extension = path.extension().string();
    const io::PictureRgb picture = equirectangular(daylight.sky, width);
    if (extension == ".png") {
        io::write_png(path, tone_mapped(picture));
    } else {
        io::write_exr_rgb(path, picture,
                          {{"skybake.sky", to_text(settings)},
                           {"skybake.instant", daylight.label},
                           {"skybake.unit", "cd/m2 per channel, linear Rec. 709"}});
    }
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
int run_weather(const DaylightSettings& settings, const SkyOptions& options, const CommonOptions& common) {
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

int run_sky(const SkyOptions& options, const CommonOptions& common) {
    if (!options.picture.empty()) {
        const std::string extension = std::filesystem::path(options.picture).extension().string();
        if (extension != ".png" && extension != ".exr")
            throw InputError(fmt::format("-o {}: the panorama is a .png or an .exr.", options.picture));
    }
    FindingLog findings;
    const DaylightSettings settings = daylight_settings_of(options.light);
    if (settings.weather && settings.instants.empty()) return run_weather(settings, options, common);
    if (settings.instants.size() > 1) {
        throw InputError(
            fmt::format("--at names {} instants; sky shows one. Call it once for each.", settings.instants.size()));
    }
    const Daylight daylight = make_daylights(settings, site_of(options.light, std::nullopt), 0.0, findings).at(0);
    const SkySettings sky = sky_at(settings, 0);
    std::optional<Queries> queries;
    if (!options.directions.empty()) queries = read_directions(options.directions);
    if (!options.picture.empty()) {
        write_picture(options.picture, daylight, sky, options.width);
        say(common,
            fmt::format("wrote {}: equirectangular, {} x {}, zenith on top, true north at the left edge, clockwise",
                        options.picture, options.width, options.width / 2));
    }
    if (common.wants_json) {
        nlohmann::json object = summary_of(daylight, sky);
        if (settings.weather) object["weather"] = weather_json(*settings.weather);
        if (queries) object["directions"] = directions_json(daylight.sky, *queries);
        object["findings"] = to_json(findings);
        print_json(object);
    } else if (queries) {
        print_csv(daylight.sky, *queries);
    } else if (options.picture.empty()) {
        print_summary(summary_of(daylight, sky));
    }
    return report_findings(common, findings);
}

}  // namespace

void add_sky(CLI::App& app, Program& program) {
    const auto options = std::make_shared<SkyOptions>();
    CLI::App* verb = add_verb(
        app, program, "sky", "Luminance and colour of the sky: summed up, in given directions, or as a panorama.",
        "  skybake sky --sun-direction 180,45\n"
        "  skybake sky --site 47.07,15.44 --at 2026-06-21T12:00+02:00 -o sky.png\n"
        "  skybake sky --sun-direction 180,45 --sky preetham:turbidity=2 --directions directions.csv\n"
        "  skybake sky --weather graz.epw\n"
        "  skybake sky --weather graz.epw --at 2026-06-21T12:00+02:00",
        [options, &program] { return run_sky(*options, program.common); });
    add_daylight_options(verb, options->light);
    verb->add_option("--directions", options->directions,
                     "CSV with azimuth_deg,elevation_deg; answers as CSV on stdout; - is stdin")
        ->type_name("CSV");
    verb->add_option("-o,--output", options->picture, "panorama: .png (tone mapped) or .exr (cd/m2 per channel)")
        ->type_name("FILE");
    verb->add_option("--width", options->width, "width of the panorama in pixels, twice its height")
        ->check(CLI::Range(2, 16384))
        ->capture_default_str();
}

}  // namespace skybake::cli
