// What the benchmarks share: a city, or the part of it about its centre, as a scene under the default clear sky.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "api/bake_city.h"

namespace skybake::bench {

/// The city's scene; objects whose box leaves the square of `radius_m` about the centre of the buildings are dropped,
/// terrain pieces too.
inline Scene load_scene(const std::string& file, double radius_m, float texel_m) {
    SilentProgress silent;
    const std::array<std::filesystem::path, 1> files{file};
    LoadedCity loaded = load_city(files, {}, silent);
    Box3d buildings;
    for (const CityObject& object : loaded.city.objects) {
        if (!is_building(object.type)) continue;
        for (const Vec3d& v : object.geometry.vertices) buildings.extend(v);
    }
    const Vec3d center = buildings.center();
    const auto is_near = [&](const Vec3d& v) {
        return std::abs(v.x - center.x) <= radius_m && std::abs(v.y - center.y) <= radius_m;
    };
    CityModel part = loaded.city;
    part.objects.clear();
    for (CityObject& object : loaded.city.objects) {
        Geometry& g = object.geometry;
        std::erase_if(g.surfaces, [&](const Surface& surface) {
            for (std::uint32_t c = g.ring_first[surface.ring_begin]; c < g.ring_first[surface.ring_end]; ++c) {
                if (!is_near(g.vertices[g.corners[c]])) return true;
            }
            return false;
        });
        g.shells.clear();
        if (!g.surfaces.empty()) part.objects.push_back(std::move(object));
    }
    FindingLog findings;
    return build_scene(part, scene_options({}, texel_m), findings);
}

/// Preetham's sky of turbidity 3 with the sun at `azimuth_deg` from grid north and `elevation_deg`.
inline Daylight clear_day(double azimuth_deg, double elevation_deg) {
    DaylightSettings settings;
    settings.sky = parse_sky("preetham:turbidity=3");
    settings.sun_direction = SunDirection{radians_from_degrees(azimuth_deg), radians_from_degrees(elevation_deg)};
    FindingLog findings;
    return make_daylights(settings, std::nullopt, 0.0, findings).front();
}

/// Noon of midsummer in Graz.
inline std::vector<Daylight> midsummer_noon() {
    return {clear_day(180.0, 66.0)};
}

/// The sun at 35° in the south-south-west: long shadows, and streets that are half lit.
inline Daylight afternoon() {
    return clear_day(200.0, 35.0);
}

}  // namespace skybake::bench
