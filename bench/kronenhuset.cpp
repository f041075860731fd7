// Sun, sky and reflected light in a real courtyard against what was measured there: Kronenhuset, Göteborg, 7 October
// 2005, six pyranometers. Usage: bench_kronenhuset FOLDER [PLOT.svg]
// Data: F. Lindberg, B. Holmer, S. Thorsson, "SOLWEIG 1.0 – Modelling spatial variations of 3D radiant fluxes and mean
// radiant temperature in complex urban settings", International Journal of Biometeorology 52, 2008.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "api/load_city.h"
#include "io/file/replace_file.h"
#include "light/path_reference.h"
#include "light/point_light.h"
#include "sky/solar_position.h"
#include "sky/weather_light.h"

namespace skybake {
namespace {

constexpr int kInstantsPerHour = 12;
constexpr double kSensorM = 1.1;                            // above the ground, as usual for a standing person's middle
constexpr Vec2d kStation{147837.673, 6398728.296};          // poi.geojson, EPSG:3007
constexpr float kGroundAlbedo = 0.15f, kWallAlbedo = 0.2f;  // what the authors' model takes for cobbles and walls
constexpr int kClockOffsetMin = 60;

struct Sensor {
    const char* name;
    Vec3f normal;
};
const std::array<Sensor, 6> kSensors{{{"Kdown", {0, 0, 1}},
                                      {"Kup", {0, 0, -1}},
                                      {"Kn", {0, 1, 0}},
                                      {"Ke", {1, 0, 0}},
                                      {"Ks", {0, -1, 0}},
                                      {"Kw", {-1, 0, 0}}}};

struct Forcing {
    double dni = 0.0, dhi = 0.0, dew_point_c = 10.0;
};
struct Flux {
    double sun = 0.0, sky = 0.0, reflected = 0.0;
    double total() const { return sun + sky + reflected; }
};
using HourFluxes = std::array<Flux, 6>;
using Measured = std::map<int, std::array<double, 6>>;  // by the hour's label

std::vector<std::string> lines_of(const std::filesystem::path& path) {
    const std::vector<std::uint8_t> bytes = io::read_file(path);
    std::istringstream text(std::string(bytes.begin(), bytes.end()));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
}

/// The columns Kdiff and Kdir by hour (columns 22 and 23 of the file).
std::map<int, Forcing> read_forcing(const std::filesystem::path& path) {
    std::map<int, Forcing> hours;
    const std::vector<std::string> lines = lines_of(path);
    for (std::size_t i = 1; i < lines.size(); ++i) {
        std::istringstream words(lines[i]);
        std::vector<double> v;
        for (double x = 0.0; words >> x;) v.push_back(x);
        if (v.size() < 23) continue;
        hours[static_cast<int>(v[2])] = {v[22], v[21], v[11]};
    }
    return hours;
}

Measured read_measured(const std::filesystem::path& path) {
    Measured hours;
    const std::vector<std::string> lines = lines_of(path);
    for (std::size_t i = 1; i < lines.size(); ++i) {
        std::istringstream words(lines[i]);
        std::array<double, 6> fluxes{};
        std::string word;
        std::getline(words, word, ',');
        const int hour = std::stoi(word);
        for (double& flux : fluxes) {
            std::getline(words, word, ',');
            flux = std::stod(word);
        }
        hours[hour] = fluxes;
    }
    return hours;
}

/// Level and low faces are ground, all others walls and roofs.
void set_albedos(Scene& scene, double ground_below_m, float ground, float wall) {
    const MaterialId first(scene.materials.size());
    scene.materials.push_back({"ground", Rgb(ground), std::nullopt, TextureWrap::repeat});
    scene.materials.push_back({"wall", Rgb(wall), std::nullopt, TextureWrap::repeat});
    for (Face& face : scene.faces) {
        const std::array<Vec3f, 3>& t = scene.triangles[face.first_triangle];
        const Vec3f normal = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
        const double z = static_cast<double>(t[0].z) + scene.origin.z;
        face.material = normal.z > 0.9f && z < ground_below_m ? first : MaterialId(first.index() + 1);
    }
}

class Courtyard {
  public:
    /// `turn_deg`: how far the sensors of the four winds are turned from the map's axes, clockwise from above.
    Courtyard(const std::filesystem::path& folder, float ground_albedo, float wall_albedo, float turn_deg = 0.0f) {
        SilentProgress silent;
        LoadOptions options;
        options.raster.content = io::RasterContent::surface;
        options.raster.max_error_m = 0.0;
        const std::array<std::filesystem::path, 1> files{folder / "DSM_KR.tif"};
        LoadedCity loaded = load_city(files, options, silent);
        site_ = loaded.georeference.site.value();
        convergence_ = loaded.georeference.convergence_rad;
        scene_ = build_scene(loaded.city, {}, loaded.findings);
        rays_.emplace(scene_);
        Vec3f above(Vec3f(static_cast<float>(kStation.x - scene_.origin.x),
                          static_cast<float>(kStation.y - scene_.origin.y), scene_.bounds.hi.z + 1.0f));
        const Hit ground = rays_->first_hit(above, {0, 0, -1}).value();
        const float z = above.z - ground.distance;
        ground_m_ = static_cast<double>(z) + scene_.origin.z;
        set_albedos(scene_, ground_m_ + 1.5, ground_albedo, wall_albedo);
        const float turn = turn_deg * static_cast<float>(kPi / 180.0), c = std::cos(turn), d = std::sin(turn);
        for (const auto& [name, n] : kSensors)
            points_.push_back(
                {{above.x, above.y, z + static_cast<float>(kSensorM)}, {c * n.x + d * n.y, c * n.y - d * n.x, n.z}});
    }
    double ground_m() const { return ground_m_; }
    std::size_t triangles() const { return scene_.triangles.size(); }

    /// Means over the hour that begins at `hour` UTC+1; the forcing stands still within it.
    HourFluxes mean(int hour, const Forcing& forcing) const {
        HourFluxes fluxes;
        for (int k = 0; k < kInstantsPerHour; ++k) {
            const double minute = 60.0 * (k + 0.5) / kInstantsPerHour;
            const UtcTime time{utc_midnight(2005, 10, 7).milliseconds +
                               std::llround(60e3 * (60.0 * hour - kClockOffsetMin + minute))};
            add(time, forcing, fluxes);
        }
        return fluxes;
    }

  private:
    void add(UtcTime time, const Forcing& forcing, HourFluxes& fluxes) const {
        const SolarPosition sun = solar_position(time, site_);
        const Vec3d direction = world_direction(sun.azimuth_rad, sun.apparent_elevation_rad, convergence_);
        const PerezSettings settings = weather_sky({forcing.dni, forcing.dhi, forcing.dew_point_c, false});
        const PerezSky sky =
            perez_sky({forcing.dni, forcing.dhi, sun.distance_au, settings.precipitable_water_cm}, direction);
        // One efficacy for sky and beam, so that lux over it is broadband.
        Daylight daylight{"", sky, {}};
        const bool is_up = sun.apparent_elevation_rad > 0.0;
        daylight.sun.direction = Vec3f(direction);
        daylight.sun.normal_illuminance = Rgb(is_up ? static_cast<float>(forcing.dni * sky.efficacy_lm_w) : 0.0f);
        daylight.sun.shape = SunShape::disc;
        const LightSources sources{daylight, {}};
        const std::array<Daylight, 1> daylights{daylight};
        const DomeSampler sampler(daylights);
        const std::vector<PointLight> direct = light_points(points_, sampler, 0, daylight.sun, *rays_, {4096, 64});
        SilentProgress silent;
        const std::vector<IndirectLight> reflected =
            PathReference(sources, scene_, *rays_, {.paths = 4096, .bounces = 8}).light(points_, silent);
        const double share = 1.0 / (kInstantsPerHour * sky.efficacy_lm_w);
        for (std::size_t i = 0; i < points_.size(); ++i) {
            fluxes[i].sun += share * static_cast<double>(luminance(direct[i].sun));
            fluxes[i].sky += share * static_cast<double>(luminance(direct[i].sky));
            fluxes[i].reflected += share * static_cast<double>(luminance(reflected[i].irradiance));
        }
    }

    Site site_;
    double convergence_ = 0.0;
    Scene scene_;
    std::optional<RayScene> rays_;
    double ground_m_ = 0.0;
    std::vector<ReceiverPoint> points_;
};

struct Errors {
    double bias = 0.0, rmse = 0.0, mean = 0.0;
    int count = 0;
    void add(double own, double measured) {
        bias += own - measured, rmse += (own - measured) * (own - measured), mean += measured;
        ++count;
    }
    void finish() {
        bias /= count, mean /= count;
        rmse = std::sqrt(rmse / count);
    }
};

/// Six panels: measured black, ours red, its parts shaded.
void write_plot(const std::filesystem::path& path, const Measured& measured, const std::map<int, HourFluxes>& own) {
    constexpr double kWide = 330.0, kHigh = 210.0;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"DejaVu Sans, sans-serif\" "
        "font-size=\"12\"><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        3 * kWide + 20, 2 * kHigh + 60);
    for (std::size_t s = 0; s < kSensors.size(); ++s) {
        double top = 50.0;
        for (const auto& [hour, fluxes] : measured) {
            top = std::max(top, fluxes[s]);
            if (own.contains(hour)) top = std::max(top, own.at(hour)[s].total());
        }
        const double step = top > 300.0 ? 100.0 : top > 120.0 ? 50.0 : top > 50.0 ? 20.0 : 10.0;
        top = step * std::ceil(top / step);
        const double x0 = 45.0 + kWide * static_cast<double>(s % 3), y0 = 25.0 + kHigh * static_cast<double>(s / 3);
        const double wide = kWide - 65.0, high = kHigh - 60.0;
        const auto x_of = [&](double hour) { return x0 + wide * (hour - 6.5) / 12.0; };
        const auto y_of = [&](double value) { return y0 + high * (1.0 - std::max(0.0, value) / top); };
        for (double v = 0.0; v <= top + 1e-6; v += step)
            svg += fmt::format(
                "<path d=\"M{:.1f} {:.1f}h{:.1f}\" stroke=\"#ddd\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
                "text-anchor=\"end\">{:g}</text>\n",
                x0, y_of(v), wide, x0 - 5, y_of(v) + 4, v);
        std::string line_measured, line_own;
        for (const auto& [hour, fluxes] : measured) {
            if (hour % 2 == 0)
                svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", x_of(hour),
                                   y0 + high + 16, hour);
            line_measured +=
                fmt::format("{}{:.1f} {:.1f}", line_measured.empty() ? "M" : "L", x_of(hour), y_of(fluxes[s]));
            svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n", x_of(hour), y_of(fluxes[s]));
            if (!own.contains(hour)) continue;
            const Flux& f = own.at(hour)[s];
            double from = 0.0;
            for (const auto& [part, colour] :
                 {std::pair{f.reflected, "#a6dba0"}, {f.sky, "#9ecae1"}, {f.sun, "#fee391"}}) {
                svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                                   x_of(hour) - 7, y_of(from + part), 14.0, y_of(from) - y_of(from + part), colour);
                from += part;
            }
            line_own += fmt::format("{}{:.1f} {:.1f}", line_own.empty() ? "M" : "L", x_of(hour), y_of(f.total()));
        }
        svg += fmt::format(
            "<path d=\"{}\" fill=\"none\" stroke=\"#cb181d\" stroke-width=\"2\"/><path d=\"{}\" fill=\"none\" "
            "stroke=\"#000\" stroke-width=\"1.5\" stroke-dasharray=\"4 3\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
            "font-weight=\"bold\">{} [W/m²]</text>\n",
            line_own, line_measured, x0, y0 - 8, kSensors[s].name);
    }
    svg += fmt::format(
        "<text x=\"45\" y=\"{0}\">measured: black, dashed; ours: red, of sun (yellow), sky (blue), reflected (green). "
        "Hours: label of the measurement; Lindberg et al. 2008.</text></svg>\n",
        2 * kHigh + 45);
    io::write_file(path, std::span(reinterpret_cast<const std::uint8_t*>(svg.data()), svg.size()));
}

/// Prints the errors; the measured label H is the hour that begins at H + `label_shift` UTC+1.
std::map<int, HourFluxes> compare(const Courtyard& court, const std::map<int, Forcing>& forcing,
                                  const Measured& measured, int label_shift, bool prints_hours) {
    std::map<int, HourFluxes> own;
    std::array<Errors, 6> errors;
    Errors all;
    for (const auto& [hour, fluxes] : measured) {
        const auto row = forcing.find(hour + label_shift);
        if (row == forcing.end()) continue;
        const HourFluxes& ours = own[hour] = court.mean(hour + label_shift, row->second);
        if (prints_hours) {
            fmt::print("| {} |", hour);
            for (std::size_t s = 0; s < 6; ++s)
                fmt::print(" {:.0f} / {:.0f} ({:.0f} + {:.0f} + {:.0f}) |", fluxes[s], ours[s].total(), ours[s].sun,
                           ours[s].sky, ours[s].reflected);
            fmt::print("\n");
        }
        for (std::size_t s = 0; s < 6; ++s)
            errors[s].add(ours[s].total(), fluxes[s]), all.add(ours[s].total(), fluxes[s]);
    }
    fmt::print("| ");
    for (Errors& e : errors) {
        e.finish();
        fmt::print("{:+.1f}, {:.1f} ({:.1f}) | ", e.bias, e.rmse, e.mean);
    }
    all.finish();
    fmt::print("{:+.1f}, {:.1f} ({:.1f}) |\n", all.bias, all.rmse, all.mean);
    return own;
}

int run(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: {} FOLDER [PLOT.svg]\n", argv[0]);
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    const std::map<int, Forcing> forcing = read_forcing(folder / "MetFile_Prepared.txt");
    const Measured measured = read_measured(folder / "measurements_kr.csv");
    const Courtyard court(folder, kGroundAlbedo, kWallAlbedo);
    fmt::print("ground {:.2f} m, {} triangles; W/m²: measured / ours (sun + sky + reflected)\n", court.ground_m(),
               court.triangles());
    const std::map<int, HourFluxes> own = compare(court, forcing, measured, -1, true);
    fmt::print("bias, RMSE (mean measured) of each sensor and of all. The label as the hour's beginning:\n");
    compare(court, forcing, measured, 0, false);
    fmt::print("as its end, but albedos of ground and walls 0.10, 0.15; 0.20, 0.30:\n");
    compare(Courtyard(folder, 0.10f, 0.15f), forcing, measured, -1, false);
    compare(Courtyard(folder, 0.20f, 0.30f), forcing, measured, -1, false);
    for (const float turn_deg : {-10.0f, -15.0f, -20.0f, -25.0f, 15.0f}) {
        fmt::print("the sensors turned clockwise by {} degrees (below 0: the other way):\n", turn_deg);
        compare(Courtyard(folder, kGroundAlbedo, kWallAlbedo, turn_deg), forcing, measured, -1, false);
    }
    if (argc > 2) write_plot(argv[2], measured, own);
    return 0;
}

}  // namespace
}  // namespace skybake

int main(int argc, char** argv) {
    return skybake::run(argc, argv);
}
