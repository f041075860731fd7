#include "study/year_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sky/solar_position.h"
#include "sky/weather_light.h"
#include "study/packets.h"

namespace skybake {
namespace {

constexpr int kParts = 4;  // of an hour of weather
constexpr int kWidth = 144, kHeight = 72;
constexpr double kSunshineWM2 = 120.0;
/// Declinations from −23.45° to 23.45° in 12 steps; hour angles from −180° on in 96.
constexpr int kDeclinations = 13, kHourAngles = 96;
constexpr double kLastDeclinationRad = 23.45 * kPi / 180.0;

/// Direction of the lattice's place, without refraction. Based on: Iqbal, "An introduction to solar radiation", 1983,
/// eq. 1.5.1, as a rotation of the equatorial frame.
Vec3d node_direction(double declination, double hour_angle, double latitude, double convergence_rad) {
    const double toward_pole = std::sin(declination);
    const double toward_meridian = std::cos(declination) * std::cos(hour_angle);
    const double north = toward_pole * std::cos(latitude) - toward_meridian * std::sin(latitude);
    const double east = -std::cos(declination) * std::sin(hour_angle);
    const double up = toward_pole * std::sin(latitude) + toward_meridian * std::cos(latitude);
    const double c = std::cos(convergence_rad), s = std::sin(convergence_rad);
    return {east * c - north * s, north * c + east * s, up};  // azimuth_grid = azimuth_true − convergence
}

class MomentMaker {
  public:
    MomentMaker(const Site& site, double convergence_rad) : site_(site), convergence_rad_(convergence_rad) {
        for (int d = 0; d < kDeclinations; ++d) {
            for (int h = 0; h < kHourAngles; ++h) {
                const double declination = kLastDeclinationRad * (2.0 * d / (kDeclinations - 1) - 1.0);
                nodes.push_back(Vec3f(node_direction(declination, 2.0 * kPi * h / kHourAngles - kPi, site.latitude_rad,
                                                     convergence_rad)));
            }
        }
    }

    /// Nothing while the sun's middle is below the horizon.
    std::optional<SunMoment> at(UtcTime time) const {
        const SolarPosition sun = solar_position(time, site_);
        if (sun.apparent_elevation_rad <= 0.0) return std::nullopt;
        SunMoment moment;
        moment.direction = Vec3f(world_direction(sun.azimuth_rad, sun.apparent_elevation_rad, convergence_rad_));
        moment.is_winter = (sun.declination_rad < 0.0) == (site_.latitude_rad >= 0.0);
        const double row =
            std::clamp((sun.declination_rad / kLastDeclinationRad + 1.0) / 2.0, 0.0, 1.0) * (kDeclinations - 1);
        const double column = (sun.hour_angle_rad + kPi) / (2.0 * kPi) * kHourAngles;
        const int d = std::min(static_cast<int>(row), kDeclinations - 2);
        const int h = static_cast<int>(column);
        double sum = 0.0;
        for (int k = 0; k < 4; ++k) {
            const int dd = d + k / 2, hh = (h + k % 2) % kHourAngles;
            const double along = row - d, across = column - h;
            moment.node[k] = static_cast<std::uint32_t>(dd * kHourAngles + hh);
            const double share = (k / 2 ? along : 1.0 - along) * (k % 2 ? across : 1.0 - across);
            // A node below the horizon says nothing: its share goes to the others.
            moment.share[k] = nodes[moment.node[k]].z > 0.0f ? static_cast<float>(share) : 0.0f;
            sum += static_cast<double>(moment.share[k]);
        }
        if (!(sum > 0.0)) return std::nullopt;  // minutes about the horizon
        for (float& share : moment.share) share = static_cast<float>(static_cast<double>(share) / sum);
        return moment;
    }

    std::vector<Vec3f> nodes;

  private:
    Site site_;
    double convergence_rad_;
};

void add_moment(YearLight& year, const SunMoment& moment) {
    year.sunshine_h += static_cast<double>(moment.sunshine_h);
    if (moment.is_winter) year.winter_sunshine_h += static_cast<double>(moment.sunshine_h);
    year.beam_kwh_m2 += 1e-3 * static_cast<double>(moment.beam_wh_m2);
    year.global_kwh_m2 += 1e-3 * static_cast<double>(moment.beam_wh_m2 * moment.direction.z);
    year.moments.push_back(moment);
}

/// Adds Perez skies into one picture, row by row in parallel.
ImageSky summed_sky(std::span<const std::pair<PerezSky, double>> skies_and_hours) {
    auto image = std::make_shared<SkyImage>();
    image->width = kWidth;
    image->height = kHeight;
    image->pixels.assign(static_cast<std::size_t>(kWidth) * kHeight, Rgb(0.0f));
    tbb::parallel_for(0, image->sky_rows(), [&](int r) {
        const double zenith = (r + 0.5) / kHeight * kPi;
        for (int c = 0; c < kWidth; ++c) {
            const double azimuth = (c + 0.5) / kWidth * 2.0 * kPi;
            const Vec3d direction(std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth),
                                  std::cos(zenith));
            double sum = 0.0;
            for (const auto& [sky, hours] : skies_and_hours)
                sum += hours * sky_luminance_cd_m2(sky, direction) / sky.efficacy_lm_w;
            image->pixels[static_cast<std::size_t>(r) * kWidth + c] = Rgb(static_cast<float>(1e-3 * sum));
        }
    });
    return ImageSky{std::move(image), 0.0};
}

}  // namespace

YearLight year_light(const Weather& weather, const Site& site, double convergence_rad, const Period& period) {
    const MomentMaker maker(site, convergence_rad);
    YearLight year;
    year.nodes = maker.nodes;
    std::vector<std::pair<PerezSky, double>> skies;
    const double interval_h = weather.interval_h();
    const int parts = std::max(1, kParts / weather.records_per_hour);
    for (const WeatherRow& row : weather.rows) {
        if (std::find(period.months.begin(), period.months.end(), row.month) == period.months.end()) continue;
        if (!row.dni || !row.dhi) continue;
        const double centre_ms =
            static_cast<double>(label_time(weather, row).milliseconds) + weather.centre.offset_h * 3600e3;
        std::vector<SunMoment> moments;
        for (int k = 0; k < parts; ++k) {
            const double part_ms = centre_ms + ((k + 0.5) / parts - 0.5) * interval_h * 3600e3;
            if (const std::optional<SunMoment> moment = maker.at({std::llround(part_ms)})) moments.push_back(*moment);
        }
        for (SunMoment& moment : moments) {
            moment.beam_wh_m2 = static_cast<float>(*row.dni * interval_h / static_cast<double>(moments.size()));
            moment.sunshine_h = *row.dni >= kSunshineWM2 ? static_cast<float>(interval_h / parts) : 0.0f;
            add_moment(year, moment);
        }
        if (!(*row.dhi > 0.0)) continue;
        const SolarPosition sun = solar_position({std::llround(centre_ms)}, site);
        WeatherHour hour{*row.dni, *row.dhi, row.dew_point_c, false};
        const PerezSettings settings = weather_sky(hour);
        const PerezWeather perez{hour.dni_w_m2, hour.dhi_w_m2, sun.distance_au, settings.precipitable_water_cm};
        skies.emplace_back(
            perez_sky(perez, world_direction(sun.azimuth_rad, sun.apparent_elevation_rad, convergence_rad)),
            interval_h);
        year.diffuse_kwh_m2 += 1e-3 * *row.dhi * interval_h;
    }
    year.global_kwh_m2 += year.diffuse_kwh_m2;
    year.sky = summed_sky(skies);
    return year;
}

YearLight cloudless_year(int year_number, const Site& site, double convergence_rad, const Period& period) {
    const MomentMaker maker(site, convergence_rad);
    YearLight year;
    year.nodes = maker.nodes;
    year.sky = summed_sky({});
    constexpr std::int64_t kStepMs = 3'600'000 / kParts;
    for (int month = 1; month <= 12; ++month) {
        if (std::find(period.months.begin(), period.months.end(), month) == period.months.end()) continue;
        const std::int64_t begin = utc_midnight(year_number, month, 1).milliseconds;
        const std::int64_t end = utc_midnight(year_number + month / 12, month % 12 + 1, 1).milliseconds;
        for (std::int64_t t = begin + kStepMs / 2; t < end; t += kStepMs) {
            std::optional<SunMoment> moment = maker.at({t});
            if (!moment) continue;
            moment->sunshine_h = 1.0f / kParts;
            add_moment(year, *moment);
        }
    }
    return year;
}

Daylight daylight_of(const YearLight& year) {
    SkyImage sun;
    sun.width = kWidth;
    sun.height = kHeight;
    sun.pixels.assign(static_cast<std::size_t>(kWidth) * kHeight, Rgb(0.0f));
    for (const SunMoment& moment : year.moments) {
        const double zenith = std::acos(std::clamp(static_cast<double>(moment.direction.z), -1.0, 1.0));
        const double azimuth =
            std::atan2(static_cast<double>(moment.direction.x), static_cast<double>(moment.direction.y));
        const int row = std::min(static_cast<int>(zenith / kPi * kHeight), sun.sky_rows() - 1);
        const int column = static_cast<int>(std::floor(azimuth / (2.0 * kPi) * kWidth) + kWidth) % kWidth;
        const double solid_angle =
            2.0 * kPi / kWidth * (std::cos(row * kPi / kHeight) - std::cos((row + 1) * kPi / kHeight));
        sun.pixels[static_cast<std::size_t>(row) * kWidth + static_cast<std::size_t>(column)] +=
            Rgb(static_cast<float>(1e-3 * static_cast<double>(moment.beam_wh_m2) / solid_angle));
    }
    const double beam_kwh_m2 = year.global_kwh_m2 - year.diffuse_kwh_m2;
    const double spread_kwh_m2 = horizontal_illuminance(sun).x;
    auto image = std::make_shared<SkyImage>(*year.sky.image);
    if (spread_kwh_m2 > 0.0) {
        const auto factor = static_cast<float>(beam_kwh_m2 / spread_kwh_m2);
        for (std::size_t i = 0; i < sun.pixels.size(); ++i) image->pixels[i] += factor * sun.pixels[i];
    }
    Daylight daylight{"period", ImageSky{std::move(image), year.sky.first_azimuth_rad}, {}};
    daylight.sun.shape = SunShape::none;
    return daylight;
}

YearSun year_sun(std::span<const Sample> samples, const Vec3d& scene_origin, const RayScene& rays,
                 const YearLight& year, Progress& progress) {
    YearSun sun;
    sun.beam_kwh_m2.resize(samples.size());
    sun.sunshine_pct.resize(samples.size());
    sun.winter_sunshine_pct.resize(samples.size());
    const std::vector<NormalGroup> groups = normal_groups(samples);
    std::vector<std::uint64_t> group_rays(groups.size());
    struct NodeWeight {
        double beam = 0.0, sunshine = 0.0, winter = 0.0;
    };
    progress.begin("sun of the year", samples.size());
    tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
        const auto& normal = groups[g].normal;  // no structured binding: clang 14 lets no inner lambda use one
        const auto& ranges = groups[g].ranges;
        std::vector<NodeWeight> weights(year.nodes.size());
        for (const SunMoment& moment : year.moments) {
            const float cosine = glm::dot(moment.direction, normal);
            if (!(cosine > 0.0f)) continue;
            for (int k = 0; k < 4; ++k) {
                NodeWeight& weight = weights[moment.node[k]];
                const double share = static_cast<double>(moment.share[k]);
                weight.beam += 1e-3 * share * static_cast<double>(moment.beam_wh_m2 * cosine);
                weight.sunshine += share * static_cast<double>(moment.sunshine_h);
                if (moment.is_winter) weight.winter += share * static_cast<double>(moment.sunshine_h);
            }
        }
        std::vector<std::size_t> used;
        for (std::size_t n = 0; n < weights.size(); ++n) {
            // A node behind the surface stands for the part of its cell that is before it: it is as dark as the wall.
            if (weights[n].beam > 0.0 || weights[n].sunshine > 0.0) used.push_back(n);
        }
        tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t r) {
            if (progress.stop_requested()) return;
            const PacketOrigins origins = packet_origins(samples, ranges[r], scene_origin, rays.surface_offset());
            DirectionPacket packet(rays);
            NodeWeight sums[RayScene::kPacketSize];
            for (const std::size_t n : used) {
                // Slightly behind the surface: the way along it decides.
                Vec3f direction = year.nodes[n];
                const float cosine = glm::dot(direction, normal);
                if (cosine < 0.01f) direction = glm::normalize(direction + (0.01f - cosine) * normal);
                if (direction.z <= 0.0f) direction = glm::normalize(Vec3f(direction.x, direction.y, 1e-3f));
                packet.set_direction(direction);
                const std::uint32_t blocked = packet.occluded(origins.x, origins.y, origins.z, origins.count);
                for (int i = 0; i < origins.count; ++i) {
                    if (blocked >> i & 1u) continue;
                    sums[i].beam += weights[n].beam;
                    sums[i].sunshine += weights[n].sunshine;
                    sums[i].winter += weights[n].winter;
                }
            }
            for (int i = 0; i < origins.count; ++i) {
                const std::size_t s = ranges[r].begin + static_cast<std::size_t>(i);
                sun.beam_kwh_m2[s] = static_cast<float>(sums[i].beam);
                if (!(year.sunshine_h > 0.0)) continue;
                sun.sunshine_pct[s] = static_cast<float>(100.0 * sums[i].sunshine / year.sunshine_h);
                sun.winter_sunshine_pct[s] = static_cast<float>(100.0 * sums[i].winter / year.sunshine_h);
            }
            progress.advance(static_cast<std::uint64_t>(origins.count));
        });
        for (const PacketRange& range : ranges) group_rays[g] += used.size() * (range.end - range.begin);
    });
    if (progress.stop_requested()) throw Interrupted();
    for (const std::uint64_t n : group_rays) sun.rays += n;
    return sun;
}

}  // namespace skybake
