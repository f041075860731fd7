#include "city/proj.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace skybake::proj {
namespace {

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

}  // namespace

ContextPtr make_context() {
    ContextPtr context(proj_context_create());
    proj_log_level(context.get(), PJ_LOG_NONE);
    proj_context_set_enable_network(context.get(), 0);
    return context;
}

std::string code_of(std::string_view name) {
    const std::string adv = adv_code_of(name);
    return adv.empty() ? epsg_code_of(name) : adv;
}

PjPtr crs_of(PJ_CONTEXT* context, const std::string& name) {
    const std::string code = code_of(name);
    PjPtr crs(proj_create(context, code.empty() ? name.c_str() : code.c_str()));
    return crs && proj_is_crs(crs.get()) ? std::move(crs) : nullptr;
}

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

bool is_geographic(PJ_TYPE type) {
    return type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
}

bool is_north_first(PJ_CONTEXT* context, const PJ* crs) {
    const PjPtr system(proj_crs_get_coordinate_system(context, crs));
    const char* direction = nullptr;
    return system &&
           proj_cs_get_axis_info(context, system.get(), 0, nullptr, nullptr, &direction, nullptr, nullptr, nullptr,
                                 nullptr) &&
           direction && std::string_view(direction) == "north";
}

PjPtr transformation(PJ_CONTEXT* context, const PJ* from, const PJ* to) {
    const PjPtr raw(proj_create_crs_to_crs_from_pj(context, from, to, nullptr, nullptr));
    return raw ? PjPtr(proj_normalize_for_visualization(context, raw.get())) : nullptr;
}

Vec2d apply(PJ* transform, PJ_DIRECTION direction, const Vec2d& p) {
    const PJ_COORD out =
        proj_trans(transform, direction, proj_coord(p.x, p.y, 0.0, std::numeric_limits<double>::infinity()));
    return {out.xy.x, out.xy.y};
}

}  // namespace skybake::proj
