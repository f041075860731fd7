// The public library: include/skybake/skybake.h over the layers of src.
#include "skybake/skybake.h"

#include <algorithm>
#include <atomic>

#include "api/bake_city.h"
#include "api/load_sky_image.h"
#include "base/error.h"
#include "sky/daylight_settings.h"
#include "sky/solar_position.h"
#include "sky/utc_time.h"

namespace skybake::api {

namespace {

class CallbackProgress final : public Progress {
  public:
    explicit CallbackProgress(const std::function<bool(const std::string&, double)>& callback) : callback_(callback) {}
    void begin(std::string_view stage, std::uint64_t total) override {
        stage_ = stage;
        total_ = total;
        done_ = 0;
        report(0.0);
    }
    void advance(std::uint64_t steps) override {
        const std::uint64_t done = done_.fetch_add(steps) + steps;
        if (total_ > 0) report(static_cast<double>(done) / static_cast<double>(total_));
    }
    bool stop_requested() const override { return is_stopped_; }

  private:
    void report(double share) {
        if (callback_ && !callback_(stage_, share)) is_stopped_ = true;
    }
    const std::function<bool(const std::string&, double)>& callback_;
    std::string stage_;
    std::uint64_t total_ = 0;
    std::atomic<std::uint64_t> done_{0};
    std::atomic<bool> is_stopped_{false};
};

Site site_of(const std::array<double, 2>& degrees) {
    if (!(std::abs(degrees[0]) <= 90.0) || !(std::abs(degrees[1]) <= 180.0))
        throw InputError("site: latitude within ±90° and longitude within ±180° are needed.");
    return {radians_from_degrees(degrees[0]), radians_from_degrees(degrees[1]), 0.0};
}

std::optional<BounceOptions> bounces_of(const Bake& settings) {
    if (settings.indirect == "none") return std::nullopt;
    if (settings.bounces < 1 || settings.bounces > 1000) throw InputError("bake: bounces must lie between 1 and 1000.");
    if (settings.photons && (*settings.photons < 1 || *settings.photons > 1'000'000'000))
        throw InputError("bake: photons must lie between 1 and 1 000 000 000.");
    if (settings.paths < 2 || settings.paths > 1 << 30)
        throw InputError("bake: paths must lie between 2 and 1 073 741 824.");
    if (settings.indirect == "photons") return BouncePhotons{{settings.photons, settings.bounces, settings.seed}, {}};
    if (settings.indirect == "reference") return PathOptions{settings.paths, settings.bounces, settings.seed};
    throw InputError("bake: indirect is \"none\", \"photons\" or \"reference\".");
}

/// Runs `body` and turns the layers' exceptions into those of the promise.
template <typename Body>
auto translated(const Body& body) {
    try {
        return body();
    } catch (const InputError& error) {
        throw Error(error.what());
    } catch (const Interrupted&) {
        throw Error("stopped by the caller");
    }
}

}  // namespace

std::string version() {
    return SKYBAKE_VERSION;
}

Sun sun_position(const std::string& time, double latitude_deg, double longitude_deg, double elevation_m) {
    return translated([&] {
        Site site = site_of({latitude_deg, longitude_deg});
        site.elevation_m = elevation_m;
        const SolarPosition position = solar_position(parse_instant(time, std::nullopt).utc, site);
        return Sun{degrees_from_radians(position.azimuth_rad), degrees_from_radians(position.elevation_rad),
                   degrees_from_radians(position.apparent_elevation_rad), position.distance_au};
    });
}

BakeResult bake(const Bake& settings) {
    return translated([&] {
        BakeCityOptions options;
        for (const std::string& file : settings.files) options.files.emplace_back(file);
        if (options.files.empty()) throw InputError("bake: name at least one city file.");
        if (!(settings.texel_m >= 0.01 && settings.texel_m <= 100.0))
            throw InputError("bake: texel_m must lie between 0.01 and 100 metres.");
        if (settings.sky_samples < 1 || settings.sky_samples > 1'000'000)
            throw InputError("bake: sky_samples must lie between 1 and 1 000 000.");
        if (settings.ground == "plane") {
            options.load.ground = GroundChoice::plane;
        } else if (settings.ground == "draped") {
            options.load.ground = GroundChoice::draped;
        } else if (settings.ground != "none") {
            throw InputError("bake: ground is \"none\", \"plane\" or \"draped\".");
        }
        if (!settings.lod.empty()) options.load.lod = settings.lod;
        options.output = settings.output;
        options.texel_m = static_cast<float>(settings.texel_m);
        options.bake.sky_samples = settings.sky_samples;
        const auto sampling = std::find(kSkySamplingNames.begin(), kSkySamplingNames.end(), settings.sampling);
        if (sampling == kSkySamplingNames.end())
            throw InputError("bake: sampling is \"projected\", \"hierarchical\" or \"full\".");
        options.bake.sampling = static_cast<SkySampling>(sampling - kSkySamplingNames.begin());
        options.bake.tolerance = static_cast<float>(settings.tolerance);
        options.bake.bounces = bounces_of(settings);
        options.seed = settings.seed;
        options.daylight.sky = parse_sky(settings.sky);
        load_sky_image(options.daylight.sky);
        options.daylight.sun = parse_sun_shape(settings.sun);
        for (const std::string& instant : settings.at)
            options.daylight.instants.push_back(parse_instant(instant, std::nullopt));
        if (settings.sun_direction_deg) {
            options.daylight.sun_direction = SunDirection{radians_from_degrees((*settings.sun_direction_deg)[0]),
                                                          radians_from_degrees((*settings.sun_direction_deg)[1])};
        }
        if (settings.site_deg) options.site = site_of(*settings.site_deg);
        options.version = version();
        options.settings = {{"sky", settings.sky},
                            {"sun", settings.sun},
                            {"ground", settings.ground},
                            {"lod", settings.lod},
                            {"indirect", settings.indirect}};
        if (options.bake.bounces) options.settings.emplace_back("bounces", std::to_string(settings.bounces));
        if (settings.indirect == "photons")
            options.settings.emplace_back("photons",
                                          settings.photons ? std::to_string(*settings.photons) : "20 per m2");
        if (settings.indirect == "reference") options.settings.emplace_back("paths", std::to_string(settings.paths));
        CallbackProgress progress(settings.progress);
        const BakeCityResult result = bake_city(options, progress);
        BakeResult answer;
        answer.buildings = result.report.buildings;
        answer.triangles = result.report.triangles;
        answer.charts = result.report.charts;
        answer.pages = result.report.pages;
        answer.texels = result.report.texels;
        answer.sky_rays = result.report.rays.sky;
        answer.seconds = result.report.seconds.total;
        answer.evaluated_fraction = result.report.evaluated_fraction;
        answer.indirect_mean_lx = result.report.indirect.mean_lx;
        answer.indirect_error_lx = result.report.indirect.error_lx;
        for (const Finding& f : result.findings.list())
            answer.findings.push_back({f.code, name_of(f.severity), f.where, f.what, f.remedy, f.count});
        return answer;
    });
}

}  // namespace skybake::api
