#include "city/georeference.h"

#include <fmt/format.h>
#include <proj.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "city/finding_codes.h"
#include "city/polygon.h"
#include "city/repair_steps.h"

namespace skybake {
namespace {

/// A projection whose scale differs more from 1 gives no true metres.
constexpr double kTrueScale = 1e-3;

struct ContextDeleter {
    void operator()(PJ_CONTEXT* c) const { proj_context_destroy(c); }
};
struct PjDeleter {
    void operator()(PJ* p) const { proj_destroy(p); }
};
using ContextPtr = std::unique_ptr<PJ_CONTEXT, ContextDeleter>;
using PjPtr = std::unique_ptr<PJ, PjDeleter>;

bool is_digits(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// "EPSG:7415" or "EPSG:25832+5783" from a code, an OGC URL or a URN, compound ones included; empty when no EPSG code
/// is in it.
std::string epsg_code_of(std::string_view name) {
    std::vector<std::string> codes;
    std::size_t at = 0;
    while ((at = name.find("EPSG", at)) != std::string_view::npos ||
           (codes.empty() && (at = name.find("epsg")) != std::string_view::npos)) {
        at += 4;
        const std::size_t end = std::min(name.find_first_of(",&?+ ", at), name.size());
        std::string_view rest = name.substr(at, end - at);  // ":7415", "::7415", "/0/7415", ":6.9:7415"
        while (!rest.empty() && (rest.back() == '/' || rest.back() == ':')) rest.remove_suffix(1);
        const std::size_t last = rest.find_last_of(":/");
        if (last != std::string_view::npos && is_digits(rest.substr(last + 1)))
            codes.emplace_back(rest.substr(last + 1));
        at = end;
        if (at < name.size() && name[at] == '+') {
            const std::size_t stop = std::min(name.find_first_not_of("0123456789", at + 1), name.size());
            if (is_digits(name.substr(at + 1, stop - at - 1))) codes.emplace_back(name.substr(at + 1, stop - at - 1));
        }
    }
    if (codes.empty()) return is_digits(name) ? fmt::format("EPSG:{}", name) : "";
    return codes.size() == 1 ? "EPSG:" + codes[0] : fmt::format("EPSG:{}+{}", codes[0], codes[1]);
}

/// "EPSG:25832+5783" for the names of the German surveys ("urn:adv:crs:ETRS89_UTM32*DE_DHHN92_NH"); empty for others.
/// Based on: GeoInfoDok 6.0, names of coordinate reference systems.
std::string adv_code_of(std::string_view name) {
    struct Entry {
        std::string_view name, code;
    };
    static constexpr std::array kHorizontal{
        Entry{"ETRS89_UTM31", "25831"}, Entry{"ETRS89_UTM32", "25832"},  Entry{"ETRS89_UTM33", "25833"},
        Entry{"DE_DHDN_3GK2", "31466"}, Entry{"DE_DHDN_3GK3", "31467"},  Entry{"DE_DHDN_3GK4", "31468"},
        Entry{"DE_DHDN_3GK5", "31469"}, Entry{"ETRS89_Lat-Lon", "4258"},
    };
    static constexpr std::array kVertical{
        Entry{"DE_DHHN2016_NH", "7837"},
        Entry{"DE_DHHN92_NH", "5783"},
        Entry{"DE_DHHN85_NOH", "5784"},
        Entry{"DE_DHHN12_NOH", "7699"},
    };
    if (name.find("adv:crs:") == std::string_view::npos) return "";
    for (const Entry& horizontal : kHorizontal) {
        if (name.find(horizontal.name) == std::string_view::npos) continue;
        for (const Entry& vertical : kVertical) {
            if (name.find(vertical.name) != std::string_view::npos)
                return fmt::format("EPSG:{}+{}", horizontal.code, vertical.code);
        }
        return fmt::format("EPSG:{}", horizontal.code);
    }
    return "";
}

std::string code_of(std::string_view name) {
    const std::string adv = adv_code_of(name);
    return adv.empty() ? epsg_code_of(name) : adv;
}

/// The two-dimensional or geographic system that x and y belong to, out of compound and bound ones.
PjPtr horizontal_of(PJ_CONTEXT* context, const PJ* crs) {
    const PJ_TYPE type = proj_get_type(crs);
    if (type == PJ_TYPE_COMPOUND_CRS) {
        const PjPtr part(proj_crs_get_sub_crs(context, crs, 0));
        return part ? horizontal_of(context, part.get()) : nullptr;
    }
    if (type == PJ_TYPE_BOUND_CRS) {
        const PjPtr source(proj_get_source_crs(context, crs));
        return source ? horizontal_of(context, source.get()) : nullptr;
    }
    return PjPtr(proj_clone(context, crs));
}

double axis_unit(PJ_CONTEXT* context, const PJ* crs, int axis) {
    const PjPtr system(proj_crs_get_coordinate_system(context, crs));
    double factor = 1.0;
    if (!system || axis >= proj_cs_get_axis_count(context, system.get())) return 1.0;
    proj_cs_get_axis_info(context, system.get(), axis, nullptr, nullptr, nullptr, &factor, nullptr, nullptr, nullptr);
    return factor;
}

bool is_geographic(PJ_TYPE type) {
    return type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
}

/// True when the first axis is the one to the north.
bool is_north_first(PJ_CONTEXT* context, const PJ* crs) {
    const PjPtr system(proj_crs_get_coordinate_system(context, crs));
    const char* direction = nullptr;
    return system &&
           proj_cs_get_axis_info(context, system.get(), 0, nullptr, nullptr, &direction, nullptr, nullptr, nullptr,
                                 nullptr) &&
           direction && std::string_view(direction) == "north";
}

/// From one system to another, x east (longitude), y north (latitude), degrees; null when PROJ knows no way.
PjPtr transformation(PJ_CONTEXT* context, const PJ* from, const PJ* to) {
    const PjPtr raw(proj_create_crs_to_crs_from_pj(context, from, to, nullptr, nullptr));
    return raw ? PjPtr(proj_normalize_for_visualization(context, raw.get())) : nullptr;
}

Vec2d apply(PJ* transform, PJ_DIRECTION direction, const Vec2d& p) {
    const PJ_COORD out =
        proj_trans(transform, direction, proj_coord(p.x, p.y, 0.0, std::numeric_limits<double>::infinity()));
    return {out.xy.x, out.xy.y};
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

/// A transverse Mercator of scale 1 about `center_degrees`.
std::string local_mercator(const Vec2d& center_degrees, const Ellipsoid& ellipsoid) {
    return fmt::format("+proj=tmerc +lat_0={:.12f} +lon_0={:.12f} +k=1 +x_0=0 +y_0=0 +a={} +rf={}", center_degrees.y,
                       center_degrees.x, ellipsoid.a,
                       ellipsoid.inverse_flattening == 0.0 ? 1e30 : ellipsoid.inverse_flattening);
}

/// Moves all vertices to the local transverse Mercator. `to_geographic` takes x east, y north.
bool project_to_metres(PJ_CONTEXT* context, CityModel& city, PJ* to_geographic, bool swap, double z_unit,
                       const Vec2d& center_degrees, const Ellipsoid& ellipsoid) {
    const PjPtr mercator(proj_create(context, local_mercator(center_degrees, ellipsoid).c_str()));
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
    const ContextPtr owner(proj_context_create());
    PJ_CONTEXT* context = owner.get();
    proj_log_level(context, PJ_LOG_NONE);
    proj_context_set_enable_network(context, 0);

    const std::string code = code_of(city.crs);
    const PjPtr crs(proj_create(context, code.empty() ? city.crs.c_str() : code.c_str()));
    const PjPtr horizontal = crs && proj_is_crs(crs.get()) ? horizontal_of(context, crs.get()) : nullptr;
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
        if (project_to_metres(context, city, nullptr, swap, 1.0, degrees, ellipsoid)) {
            result.coordinate_crs = local_mercator(degrees, ellipsoid) + " +units=m +type=crs";
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
    if (project_to_metres(context, city, to_geodetic.get(), false, z_unit, degrees, ellipsoid)) {
        result.coordinate_crs = local_mercator(degrees, ellipsoid) + " +units=m +type=crs";
        add("SB302", fmt::format("{} shows a metre as {:.4f} here; coordinates were projected to a transverse Mercator "
                                 "about {:.6f} N {:.6f} E.",
                                 result.crs_name, scale.north, degrees.y, degrees.x));
        result.convergence_rad = 0.0;
        result.site->elevation_m = box.lo.z * z_unit;
    }
    return result;
}

bool is_geographic_crs(const std::string& name) {
    const ContextPtr context(proj_context_create());
    proj_log_level(context.get(), PJ_LOG_NONE);
    proj_context_set_enable_network(context.get(), 0);
    const std::string code = code_of(name);
    const PjPtr crs(proj_create(context.get(), code.empty() ? name.c_str() : code.c_str()));
    const PjPtr horizontal = crs && proj_is_crs(crs.get()) ? horizontal_of(context.get(), crs.get()) : nullptr;
    return horizontal && is_geographic(proj_get_type(horizontal.get()));
}

}  // namespace skybake
