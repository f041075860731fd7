// Skies and obstacles with which the directions of the dome are judged: by the tests, and by bench/dome_error.cpp.
#pragma once

#include <tbb/parallel_for.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sky/daylight_settings.h"
#include "sky/dome_sampling.h"
#include "sky/solar_position.h"

namespace skybake {

struct NamedSky {
    std::string name;
    Daylight daylight;
    DomeSampler sampler = DomeSampler(std::span(&daylight, 1));
};

/// A picture of a Preetham sky with its sun in it, a disc of half a degree that outshines it 10⁵ times.
inline std::shared_ptr<const SkyImage> picture_with_sun(double azimuth_deg, double elevation_deg) {
    const Vec3d sun = world_direction(radians_from_degrees(azimuth_deg), radians_from_degrees(elevation_deg), 0.0);
    const SkyModel preetham = scaled_to(preetham_sky(3.0, sun), 15'000.0);
    SkyImage image{2048, 1024, {}};
    image.pixels.assign(2048 * 1024, Rgb(0.0f));
    for (int row = 0; row < 512; ++row) {
        for (int column = 0; column < 2048; ++column) {
            const Vec3d view =
                world_direction(2.0 * kPi * (column + 0.5) / 2048, kPi * (0.5 - (row + 0.5) / 1024), 0.0);
            Rgb& pixel = image.pixels[row * 2048 + column];
            pixel = sky_luminance(preetham, Vec3f(view));
            if (glm::dot(view, sun) > std::cos(radians_from_degrees(0.27))) pixel = Rgb(1e9f, 1e9f, 9e8f);
        }
    }
    return std::make_shared<const SkyImage>(std::move(image));
}

/// Every kind of sky, the sun in the south-east at 10° or 40°.
inline std::vector<NamedSky> skies_to_judge() {
    std::vector<NamedSky> skies;
    FindingLog unheard;
    for (const double elevation : {40.0, 10.0}) {
        DaylightSettings settings;
        settings.sun_direction = SunDirection{radians_from_degrees(135.0), radians_from_degrees(elevation)};
        for (const char* text :
             {"uniform:luminance=3000", "preetham:turbidity=2", "preetham:turbidity=6", "perez:dni=800,dhi=80",
              "perez:dni=300,dhi=150", "perez:dni=0,dhi=120", "cie:type=1", "cie:type=8", "cie:type=12", "cie:type=15",
              "cie1994:turbid", "cie1994:intermediate"}) {
            settings.sky = parse_sky(text);
            skies.push_back({std::string(text) + (elevation > 20.0 ? ", sun 40°" : ", sun 10°"),
                             make_daylights(settings, std::nullopt, 0.0, unheard).at(0)});
        }
        Daylight image;
        image.sky = ImageSky{picture_with_sun(135.0, elevation), 0.0};
        skies.push_back({elevation > 20.0 ? "image with its sun, 40°" : "image with its sun, 10°", image});
    }
    return skies;
}

/// What stands in the way of a receiver.
struct Obstacle {
    std::string name;
    Vec3f normal;                               // of the receiver
    std::function<bool(const Vec3f&)> is_free;  // whether a direction reaches the sky
};

/// Ground and walls, free, behind a half of the dome, and in streets. No edge passes within 4° of the sun of
/// skies_to_judge(): half a disc is what --sun disc is for.
inline std::vector<Obstacle> obstacles_to_judge() {
    const auto towards = [](double azimuth_deg) {
        return Vec3f(world_direction(radians_from_degrees(azimuth_deg), 0.0, 0.0));
    };
    const Vec3f up(0.0f, 0.0f, 1.0f);
    std::vector<Obstacle> obstacles;
    obstacles.push_back({"free ground", up, [](const Vec3f&) { return true; }});
    for (const double azimuth : {35.0, 125.0, 215.0, 305.0}) {
        const Vec3f wall = towards(azimuth);
        obstacles.push_back({"free wall", wall, [](const Vec3f&) { return true; }});
        obstacles.push_back({"half dome", up, [wall](const Vec3f& d) { return glm::dot(d, wall) > 0.0f; }});
        // A street as deep as wide, along the wall; the receiver in its middle.
        obstacles.push_back(
            {"street", up, [wall](const Vec3f& d) { return d.z > 2.0f * std::abs(glm::dot(d, wall)); }});
        // A wall with houses across the street: 30° of elevation at right angles are hidden.
        obstacles.push_back(
            {"wall in a street", wall, [wall](const Vec3f& d) { return d.z > 0.577f * std::abs(glm::dot(d, wall)); }});
    }
    return obstacles;
}

/// Illuminance by midpoints: of a fine grid in azimuth and height, or of a picture's pixels.
inline double exact_illuminance(const SkyModel& sky, const Obstacle& obstacle) {
    const auto* image = std::get_if<ImageSky>(&sky);
    const int azimuths = image ? image->image->width : 1024;
    const int heights = image ? image->image->sky_rows() : 512;
    std::vector<double> row_sum(static_cast<std::size_t>(heights));
    tbb::parallel_for(0, heights, [&](int row) {
        const double low = image ? std::cos(kPi / 2.0 * (row + 1) / heights) : static_cast<double>(row) / heights;
        const double high = image ? std::cos(kPi / 2.0 * row / heights) : (row + 1.0) / heights;
        const double z = image ? std::cos(kPi / 2.0 * (row + 0.5) / heights) : 0.5 * (low + high);
        const double r = std::sqrt(1.0 - z * z);
        for (int a = 0; a < azimuths; ++a) {
            const double azimuth = 2.0 * kPi * (a + 0.5) / azimuths;
            const Vec3f direction(Vec3d(r * std::sin(azimuth), r * std::cos(azimuth), z));
            const float cosine = glm::dot(direction, obstacle.normal);
            if (cosine > 0.0f && obstacle.is_free(direction))
                row_sum[static_cast<std::size_t>(row)] +=
                    static_cast<double>(cosine * luminance(sky_luminance(sky, direction))) * (high - low);
        }
    });
    double sum = 0.0;
    for (const double row : row_sum) sum += row;
    return sum * 2.0 * kPi / azimuths;
}

/// The sampler's answer: weights of the free directions.
inline double sampled_illuminance(const DomeSampler& sampler, const Obstacle& obstacle, int count) {
    const DomeSamples samples = sampler.sample(obstacle.normal, count);
    double sum = 0.0;
    for (std::size_t j = 0; j < samples.size(); ++j) {
        if (obstacle.is_free(samples.directions[j])) sum += static_cast<double>(luminance(samples.weights[0][j]));
    }
    return sum;
}

/// The plain Monte Carlo sum of luminance × cosine over density, without the ratio to the table.
inline double unscaled_illuminance(const DomeSampler& sampler, const SkyModel& sky, const Obstacle& obstacle,
                                   int count) {
    const DomeSamples samples = sampler.sample(obstacle.normal, count);
    const std::vector<double> pdf = sampler.pdf_solid_angle(obstacle.normal, samples.directions);
    double sum = 0.0;
    for (std::size_t j = 0; j < samples.size(); ++j) {
        const Vec3f& direction = samples.directions[j];
        if (obstacle.is_free(direction)) {
            sum +=
                static_cast<double>(glm::dot(direction, obstacle.normal) * luminance(sky_luminance(sky, direction))) /
                pdf[j];
        }
    }
    return sum / count;
}

}  // namespace skybake
