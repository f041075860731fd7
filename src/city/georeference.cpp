#include "city/georeference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>
#include <vector>

#include "city/finding_codes.h"
#include "city/polygon.h"
#include "city/proj.h"
#include "city/repair_steps.h"

namespace skybake {
using namespace proj;
namespace {

/// A projection whose scale differs more from 1 gives no true metres.
constexpr double kTrueScale = 1e-3;

double axis_unit(PJ_CONTEXT* context, const PJ* crs, int axis) {
    const PjPtr system(proj_crs_get_coordinate_system(context, crs));
    double factor = 1.0;
    if (!system || axis >= proj_cs_get_axis_count(context, system.get())) return 1.0;
    proj_cs_get_axis_info(context, system.get(), axis, nullptr, nullptr, nullptr, &factor, nullptr, nullptr, nullptr);
    return factor;
}

bool is_finite(const Vec2d& p) {
    return std::isfinite(p.x) && std::isfinite(p.y);
}

struct Ellipsoid {
    double a = 6378137.0;
    double inverse_flattening = 298.257223563;

    double e2() const {
        return inverse_flattening == 0.0 ? 0.0 : (2.0 - 1.0 / inverse_flattening) / inverse_flattening;
    }
    /// Metres along the meridian, and along the parallel, for one radian. Based on: Snyder, "Map Projections: A Working
    /// Manual", 1987, eq. 4-18, 4-20.
    Vec2d metres_per_radian(double latitude) const {
        const double w2 = 1.0 - e2() * std::sin(latitude) * std::sin(latitude);
        return {a * std::cos(latitude) / std::sqrt(w2), a * (1.0 - e2()) / (w2 * std::sqrt(w2))};
    }
};

/// How a projection shows a small step to the east and to the north.
struct LocalScale {
    double east = 1.0, north = 1.0;  // grid length by true length
    double convergence_rad = 0.0;
};

/// By central differences of 10⁻⁴ degrees (10 m): error about 10⁻⁹.
LocalScale local_scale(PJ* from_geographic, const Vec2d& degrees, const Ellipsoid& ellipsoid) {
    constexpr double kStep = 1e-4;
    const auto step = [&](const Vec2d& d) {
        return apply(from_geographic, PJ_FWD, degrees + d) - apply(from_geographic, PJ_FWD, degrees - d);
    };
    const Vec2d east = step({kStep, 0.0});
    const Vec2d north = step({0.0, kStep});
    const Vec2d metres = ellipsoid.metres_per_radian(radians_from_degrees(degrees.y)) * radians_from_degrees(2 * kStep);
    return {glm::length(east) / metres.x, glm::length(north) / metres.y, -std::atan2(north.x, north.y)};
}

Box3d vertex_box(const CityModel& city) {
    Box3d box;
    for (const CityObject& object : city.objects) {
        for (const Vec3d& p : object.geometry.vertices) {
            if (repair_steps::is_place(p)) box.extend(p);
        }
    }
    return box;
}

/// The volume that the solids enclose, in the units of the file: negative when they are inside out, as they are where x
/// and y are exchanged; 0 without solids.
double enclosed_volume(const CityModel& city) {
    double volume = 0.0;
    for (const CityObject& object : city.objects) {
        const Geometry& g = object.geometry;
        for (const Shell& shell : g.shells) {
            if (shell.kind != Shell::Kind::outer) continue;
            const Vec3d origin = g.vertices[ring_of(g, g.surfaces[shell.surface_begin].ring_begin)[0]];
            for (std::uint32_t s = shell.surface_begin; s < shell.surface_end; ++s) {
                const Vec3d corner = g.vertices[ring_of(g, g.surfaces[s].ring_begin)[0]];
                volume += glm::dot(corner - origin, surface_area_vector(g, g.surfaces[s]));
            }
        }
    }
    return volume;
}

bool is_geocentric(PJ_CONTEXT* context, const std::string& name) {
    const PjPtr crs = crs_of(context, name);
    return crs && proj_get_type(crs.get()) == PJ_TYPE_GEOCENTRIC_CRS;
}

/// Places about the Earth's centre become latitude, longitude and height above the ellipsoid.
void to_geographic(PJ_CONTEXT* context, CityModel& city) {
    constexpr const char* kGeographic = "EPSG:4979";  // latitude first
    const PjPtr from = crs_of(context, city.crs), to = crs_of(context, kGeographic);
    const PjPtr transform = from && to ? transformation(context, from.get(), to.get()) : nullptr;
    if (!transform) return;
    for (CityObject& object : city.objects) {
        for (Vec3d& p : object.geometry.vertices) {
            if (!repair_steps::is_place(p)) continue;
            const PJ_COORD out = proj_trans(transform.get(), PJ_FWD, proj_coord(p.x, p.y, p.z, HUGE_VAL));
            p = {out.xyz.y, out.xyz.x, out.xyz.z};
        }
    }
    city.crs = kGeographic;
}

/// A transverse Mercator of scale 1 about `center_degrees`, as PROJ's definition.
std::string local_projection(const Vec2d& center_degrees, const Ellipsoid& ellipsoid) {
    return fmt::format("+proj=tmerc +lat_0={:.12f} +lon_0={:.12f} +k=1 +x_0=0 +y_0=0 +a={} +rf={}", center_degrees.y,
                       center_degrees.x, ellipsoid.a,
                       ellipsoid.inverse_flattening == 0.0 ? 1e30 : ellipsoid.inverse_flattening);
}

/// Moves all vertices to `projection`. `to_geographic` takes x east, y north.
bool project_to_metres(PJ_CONTEXT* context, CityModel& city, PJ* to_geographic, bool swap, double z_unit,
                       const std::string& projection) {
    const PjPtr mercator(proj_create(context, projection.c_str()));
    if (!mercator) return false;
    for (CityObject& object : city.objects) {
        for (Vec3d& p : object.geometry.vertices) {
            if (!repair_steps::is_place(p)) continue;
            Vec2d degrees = swap ? Vec2d(p.y, p.x) : Vec2d(p.x, p.y);
            if (to_geographic) degrees = apply(to_geographic, PJ_FWD, degrees);
            const Vec2d metres =
                apply(mercator.get(), PJ_FWD, {radians_from_degrees(degrees.x), radians_from_degrees(degrees.y)});
            p = {metres.x, metres.y, p.z * z_unit};
        }
    }
    return true;
}

}  // namespace

Georeference georeference(CityModel& city, FindingLog& findings) {
    Georeference result;
    const std::string where =
        city.files.empty() ? "city" : std::filesystem::path(city.files.front()).filename().string();
    const auto add = [&](std::string_view code, std::string what) {
        findings.add(make_finding(code, where, std::move(what)));
    };
    if (city.crs.empty()) {
        add("SB304",
            "names no coordinate reference system; coordinates are taken as metres, grid north as true north.");
        return result;
    }
    const ContextPtr owner = make_context();
    PJ_CONTEXT* context = owner.get();
    if (is_geocentric(context, city.crs)) to_geographic(context, city);
    const std::string code = code_of(city.crs);
    const PjPtr crs = crs_of(context, city.crs);
    const PjPtr horizontal = crs ? horizontal_of(context, crs.get()) : nullptr;
    const PJ_TYPE type = horizontal ? proj_get_type(horizontal.get()) : PJ_TYPE_UNKNOWN;
    if (!horizontal || !(is_geographic(type) || type == PJ_TYPE_PROJECTED_CRS)) {
        add("SB303", fmt::format("its coordinate reference system '{}' is unknown, or neither projected nor "
                                 "geographic; coordinates are taken as metres, grid north as true north.",
                                 city.crs));
        return result;
    }
    result.crs_code = code;
    const char* name = proj_get_name(crs.get());
    result.crs_name = fmt::format("{}{}{}", code, code.empty() ? "" : " ", name ? name : "");

    Box3d box = vertex_box(city);
    if (box.is_empty()) return result;
    if (type == PJ_TYPE_PROJECTED_CRS && is_north_first(context, horizontal.get()) && enclosed_volume(city) < 0.0) {
        for (CityObject& object : city.objects) {
            for (Vec3d& p : object.geometry.vertices) std::swap(p.x, p.y);
        }
        box = vertex_box(city);
        add("SB307",
            fmt::format("solids are inside out and {} has north first; x and y were exchanged.", result.crs_name));
    }
    Ellipsoid ellipsoid;
    if (const PjPtr e{proj_get_ellipsoid(context, horizontal.get())}) {
        proj_ellipsoid_get_parameters(context, e.get(), &ellipsoid.a, nullptr, nullptr, &ellipsoid.inverse_flattening);
    }
    double west = -180.0, south = -90.0, east = 180.0, north = 90.0;
    proj_get_area_of_use(context, horizontal.get(), &west, &south, &east, &north, nullptr);
    const auto is_in_area = [&](const Vec2d& degrees) {
        constexpr double kMargin = 0.5;  // areas of use are rough
        const bool is_lon = west <= east ? degrees.x >= west - kMargin && degrees.x <= east + kMargin
                                         : degrees.x >= west - kMargin || degrees.x <= east + kMargin;
        return is_finite(degrees) && is_lon && degrees.y >= south - kMargin && degrees.y <= north + kMargin;
    };

    const PjPtr geodetic(proj_crs_get_geodetic_crs(context, horizontal.get()));
    const PjPtr wgs84(proj_create(context, "EPSG:4326"));
    const PjPtr to_wgs84 = wgs84 ? transformation(context, horizontal.get(), wgs84.get()) : nullptr;
    const Vec2d center(box.center());
    const bool is_degrees = is_geographic(type);
    // Files keep to the system's order of axes, latitude first, or write longitude first. Solids tell, which are inside
    // out in the wrong order; and the area of use.
    bool swap = is_degrees && is_north_first(context, horizontal.get());
    if (const double volume = swap ? enclosed_volume(city) : 0.0; volume != 0.0) swap = volume < 0.0;
    if (is_degrees && !is_in_area(swap ? Vec2d(center.y, center.x) : center) &&
        is_in_area(swap ? center : Vec2d(center.y, center.x))) {
        swap = !swap;
    }
    const char* wkt = geodetic ? proj_as_wkt(context, geodetic.get(), PJ_WKT2_2019, nullptr) : nullptr;
    const auto note_projection = [&](const std::string& projection) {
        result.local_projection = projection;
        result.local_geographic = wkt ? wkt : "";
    };
    const PjPtr to_geodetic = is_degrees ? nullptr
                              : geodetic ? transformation(context, horizontal.get(), geodetic.get())
                                         : nullptr;
    const Vec2d ordered = swap ? Vec2d(center.y, center.x) : center;
    const Vec2d degrees = is_degrees ? ordered : to_geodetic ? apply(to_geodetic.get(), PJ_FWD, ordered) : Vec2d(NAN);
    const Vec2d site = to_wgs84 ? apply(to_wgs84.get(), PJ_FWD, ordered) : degrees;
    if (!is_in_area(degrees) || !is_finite(site)) {
        add("SB305", fmt::format("coordinates about ({:.1f}, {:.1f}) lie outside the area of {}; taken as metres, grid "
                                 "north as true north.",
                                 center.x, center.y, result.crs_name));
        return result;
    }
    result.site = Site{radians_from_degrees(site.y), radians_from_degrees(site.x), box.lo.z};
    if (is_degrees) {
        const std::string projection = local_projection(degrees, ellipsoid);
        if (project_to_metres(context, city, nullptr, swap, 1.0, projection)) {
            note_projection(projection);
            result.coordinate_crs = projection + " +units=m +type=crs";
            add("SB301",
                fmt::format(
                    "coordinates in degrees of {} were projected to a transverse Mercator about {:.6f} N {:.6f} E.",
                    result.crs_name, degrees.y, degrees.x));
        }
        return result;
    }
    result.coordinate_crs = code.empty() ? city.crs : code;
    const PjPtr from_geodetic = transformation(context, geodetic.get(), horizontal.get());
    if (!from_geodetic) return result;
    const LocalScale scale = local_scale(from_geodetic.get(), degrees, ellipsoid);
    result.convergence_rad = scale.convergence_rad;
    if (std::abs(scale.east - 1.0) <= kTrueScale && std::abs(scale.north - 1.0) <= kTrueScale) return result;

    double z_unit =
        axis_unit(context, horizontal.get(), 0);  // heights without a system of their own share the map's unit
    if (proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS) {
        if (const PjPtr vertical{proj_crs_get_sub_crs(context, crs.get(), 1)})
            z_unit = axis_unit(context, vertical.get(), 0);
    }
    const std::string projection = local_projection(degrees, ellipsoid);
    if (project_to_metres(context, city, to_geodetic.get(), false, z_unit, projection)) {
        note_projection(projection);
        result.coordinate_crs = projection + " +units=m +type=crs";
        add("SB302", fmt::format("{} shows a metre as {:.4f} here; coordinates were projected to a transverse Mercator "
                                 "about {:.6f} N {:.6f} E.",
                                 result.crs_name, scale.north, degrees.y, degrees.x));
        result.convergence_rad = 0.0;
        result.site->elevation_m = box.lo.z * z_unit;
    }
    return result;
}

bool is_geographic_crs(const std::string& name) {
    const ContextPtr context = make_context();
    const PjPtr crs = crs_of(context.get(), name);
    const PjPtr horizontal = crs ? horizontal_of(context.get(), crs.get()) : nullptr;
    return horizontal && is_geographic(proj_get_type(horizontal.get()));
}

void to_named_system(CityModel& city, const Georeference& georeference) {
    const auto url = [](std::string_view number) {
        return fmt::format("https://www.opengis.net/def/crs/EPSG/0/{}", number);
    };
    if (georeference.local_projection.empty()) {
        const std::string_view code = georeference.crs_code;
        const std::size_t plus = std::min(code.find('+'), code.size());
        if (code.empty()) {
            city.crs.clear();
        } else if (plus == code.size()) {
            city.crs = url(code.substr(5));
        } else {
            city.crs = fmt::format("https://www.opengis.net/def/crs-compound?1={}&2={}", url(code.substr(5, plus - 5)),
                                   url(code.substr(plus + 1)));
        }
        return;
    }
    city.crs.clear();
    if (!georeference.site) return;
    const double longitude = degrees_from_radians(georeference.site->longitude_rad);
    const int zone = std::clamp(static_cast<int>(std::floor((longitude + 180.0) / 6.0)) + 1, 1, 60);
    const int epsg = (georeference.site->latitude_rad < 0.0 ? 32700 : 32600) + zone;
    const ContextPtr context = make_context();
    const PjPtr mercator(proj_create(context.get(), georeference.local_projection.c_str()));
    const PjPtr from(proj_create(context.get(), georeference.local_geographic.c_str()));
    const PjPtr to = crs_of(context.get(), fmt::format("EPSG:{}", epsg));
    const PjPtr transform = mercator && from && to ? transformation(context.get(), from.get(), to.get()) : nullptr;
    if (!transform) return;
    for (CityObject& object : city.objects) {
        for (Vec3d& p : object.geometry.vertices) {
            const Vec2d radians = apply(mercator.get(), PJ_INV, Vec2d(p));
            const Vec2d utm =
                apply(transform.get(), PJ_FWD, {degrees_from_radians(radians.x), degrees_from_radians(radians.y)});
            p = Vec3d(utm, p.z);
        }
    }
    city.crs = url(std::to_string(epsg));
}

void bring_into_system(CityModel& city, std::size_t first_object, const std::string& from_name, const std::string& file,
                       FindingLog& findings) {
    const auto tell = [&](std::string_view code, std::string what) {
        findings.add(make_finding(code, file, std::move(what)));
    };
    if (code_of(from_name) == code_of(city.crs) && (from_name == city.crs || !code_of(from_name).empty())) return;
    const ContextPtr context = make_context();
    const PjPtr from_crs = crs_of(context.get(), from_name), to_crs = crs_of(context.get(), city.crs);
    const PjPtr from = from_crs ? horizontal_of(context.get(), from_crs.get()) : nullptr;
    const PjPtr to = to_crs ? horizontal_of(context.get(), to_crs.get()) : nullptr;
    if (from && to && proj_is_equivalent_to(from.get(), to.get(), PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS)) return;
    const PjPtr transform = from && to ? transformation(context.get(), from.get(), to.get()) : nullptr;
    if (!transform) {
        tell("SB306", fmt::format("names '{}', the files before it '{}', and no way leads from one to the other here; "
                                  "taken as one system.",
                                  from_name, city.crs));
        return;
    }
    const auto is_latitude_first = [&](const PJ* crs) {
        return is_geographic(proj_get_type(crs)) && is_north_first(context.get(), crs);
    };
    const bool swaps_from = is_latitude_first(from.get()), swaps_to = is_latitude_first(to.get());
    const auto swapped = [](const Vec2d& p) { return Vec2d(p.y, p.x); };
    for (std::size_t i = first_object; i < city.objects.size(); ++i) {
        for (Vec3d& p : city.objects[i].geometry.vertices) {
            if (!repair_steps::is_place(p)) continue;
            const Vec2d moved = apply(transform.get(), PJ_FWD, swaps_from ? swapped(Vec2d(p)) : Vec2d(p));
            p = Vec3d(swaps_to ? swapped(moved) : moved, p.z);  // heights keep their own system
        }
    }
    tell("SB308", fmt::format("names '{}', the files before it '{}'; it was brought into theirs, heights as they are.",
                              from_name, city.crs));
}

}  // namespace skybake
