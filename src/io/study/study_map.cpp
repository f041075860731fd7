#include "io/study/study_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "io/html/html.h"
#include "io/image/image.h"
#include "io/xml/xml_text.h"

namespace skybake::io {
namespace {

constexpr Rgb8 kPaper{255, 255, 255}, kGround{244, 244, 241}, kHouse{205, 205, 203}, kRim{120, 120, 120},
    kPlan{170, 120, 190}, kPlanRim{90, 30, 120};
constexpr double kLineM = 1.6;  // width of façades on a map, but at least so many pixels:
constexpr double kLinePixels = 3.0;
constexpr double kPointPixels = 7.0;

class Painter {
  public:
    Painter(const StudyMap& map, std::vector<Rgb8>& pixels) : map_(map), view_(map.ground->view), pixels_(pixels) {}

    void paint() {
        const std::vector<float>& values = *map_.values;
        std::vector<std::uint32_t> order(values.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return map_.shows_worst_low ? values[a] > values[b] : values[a] < values[b];
        });
        // Ground below roofs, both below façades, points on top.
        for (const auto& kinds : {std::vector{ReceiverKind::ground, ReceiverKind::polygon},
                                  {ReceiverKind::roof},
                                  {ReceiverKind::facade, ReceiverKind::window},
                                  {ReceiverKind::point}}) {
            for (const std::uint32_t i : order) {
                const Sample& sample = map_.receivers->samples[i];
                const ReceiverKind kind = map_.receivers->receivers[sample.receiver].kind;
                if (std::isnan(values[i]) || std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) continue;
                cell(sample, kind, map_.scale.colours[map_.scale.class_of(static_cast<double>(values[i]))]);
            }
        }
    }

  private:
    template <typename IsIn>
    void fill(const Vec2d& lo, const Vec2d& hi, const Rgb8& colour, bool spares_houses, const IsIn& is_in) {
        const Vec2d a = (lo - view_.lo) / view_.pixel_m, b = (hi - view_.lo) / view_.pixel_m;
        const int c0 = std::max(0, static_cast<int>(std::floor(a.x))),
                  c1 = std::min(view_.width - 1, static_cast<int>(std::ceil(b.x)));
        const int r0 = std::max(0, view_.height - 1 - static_cast<int>(std::ceil(b.y))),
                  r1 = std::min(view_.height - 1, view_.height - static_cast<int>(std::floor(a.y)));
        for (int r = r0; r <= r1; ++r) {
            for (int c = c0; c <= c1; ++c) {
                const std::size_t p = static_cast<std::size_t>(r) * view_.width + c;
                const std::uint32_t object = view_.object[p];
                if (spares_houses && object != PlanView::kNothing && map_.ground->is_building[object]) continue;
                if (is_in(view_.lo + view_.pixel_m * Vec2d(c + 0.5, view_.height - r - 0.5))) pixels_[p] = colour;
            }
        }
    }

    void cell(const Sample& sample, ReceiverKind kind, const Rgb8& colour) {
        const Vec2d at(sample.position);
        if (kind == ReceiverKind::point) {
            const double radius = kPointPixels * view_.pixel_m;
            fill(at - radius, at + radius, {0, 0, 0}, false,
                 [&](const Vec2d& p) { return glm::length(p - at) < radius; });
            fill(at - radius, at + radius, colour, false,
                 [&](const Vec2d& p) { return glm::length(p - at) < 0.7 * radius; });
            return;
        }
        const Vec2d corner = at + Vec2d(Vec3d(sample.corner)), u(Vec3d(sample.u)), v(Vec3d(sample.v));
        const double det = u.x * v.y - u.y * v.x;
        const Vec2d ends[4] = {corner, corner + u, corner + v, corner + u + v};
        Vec2d lo = ends[0], hi = ends[0];
        for (const Vec2d& p : ends) lo = glm::min(lo, p), hi = glm::max(hi, p);
        if (std::abs(det) > 0.2 * glm::length(sample.u) * glm::length(sample.v)) {
            fill(lo, hi, colour, kind != ReceiverKind::roof, [&](const Vec2d& p) {
                const Vec2d d = p - corner;
                const double s = (d.x * v.y - d.y * v.x) / det, t = (u.x * d.y - u.y * d.x) / det;
                return s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0;
            });
            return;
        }
        // Upright: a line before the wall.
        const double width = std::max(kLineM, kLinePixels * view_.pixel_m);
        const Vec2d outward = glm::normalize(Vec2d(Vec3d(sample.normal)) + Vec2d(1e-12, 0.0));
        fill(lo - width, hi + width, colour, false, [&](const Vec2d& p) {
            const Vec2d d = p - corner;
            const Vec2d along(-outward.y, outward.x);
            double from = 1e30, to = -1e30;
            for (const Vec2d& end : ends) {
                from = std::min(from, glm::dot(end - corner, along));
                to = std::max(to, glm::dot(end - corner, along));
            }
            const double s = glm::dot(d, along), t = glm::dot(d, outward);
            return s >= from && s <= to && t >= -0.3 * width && t <= 0.7 * width;
        });
    }

    const StudyMap& map_;
    const PlanView& view_;
    std::vector<Rgb8>& pixels_;
};

std::string text_svg(double x, double y, const char* anchor, bool is_bold, const std::string& text) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>", x, y, anchor,
                       is_bold ? " font-weight=\"bold\"" : "", xml_text(text));
}

std::string legend_svg(const StudyMap& map, const Words& words) {
    std::string out;
    const std::size_t classes = map.scale.colours.size();
    const double width = std::min(90.0, (860.0 / map.lettering - 40.0) / static_cast<double>(classes));
    for (std::size_t c = 0; c < classes; ++c) {
        out += fmt::format("<rect x=\"{:.1f}\" y=\"12\" width=\"{:.1f}\" height=\"22\" fill=\"{}\" stroke=\"#444\"/>",
                           30.0 + width * static_cast<double>(c), width, hex_of(map.scale.colours[c]));
    }
    // As few decimals as tell the edges apart.
    const auto text_of = [&](double edge) {
        int decimals = 0;
        while (decimals < 3 &&
               std::abs(edge * std::pow(10.0, decimals) - std::round(edge * std::pow(10.0, decimals))) > 1e-6)
            ++decimals;
        return words.number(edge, decimals);
    };
    for (std::size_t e = 0; e < map.scale.edges.size(); ++e) {
        const double x = 30.0 + width * static_cast<double>(e);
        const bool is_marked = map.scale.is_marked[e];
        if (is_marked) out += fmt::format("<path d=\"M{0:.1f} 6V40\" stroke=\"#000\" stroke-width=\"3\"/>", x);
        // The class about no change has one label in its middle.
        const bool begins_none =
            e + 1 < map.scale.edges.size() && map.scale.edges[e] < 0.0 && map.scale.edges[e] == -map.scale.edges[e + 1];
        const bool ends_none = e > 0 && map.scale.edges[e] > 0.0 && map.scale.edges[e] == -map.scale.edges[e - 1];
        if (ends_none) continue;
        if (begins_none)
            out += text_svg(x + 0.5 * width, 54.0, "middle", false, "0");
        else
            out += text_svg(x, 54.0, "middle", is_marked, text_of(map.scale.edges[e]));
    }
    out += text_svg(30.0 + width * static_cast<double>(classes) + 18.0, 30.0, "start", false, map.unit);
    return out;
}

double round_length(double most) {
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    return (most >= 5.0 * power ? 5.0 : most >= 2.0 * power ? 2.0 : 1.0) * power;
}

}  // namespace

std::vector<Rgb8> ground_pixels(const MapGround& ground) {
    const PlanView& view = ground.view;
    std::vector<Rgb8> pixels(view.object.size(), kPaper);
    const auto group = [&](std::size_t p) -> const std::string* {
        const std::uint32_t o = view.object[p];
        return o != PlanView::kNothing && ground.is_building[o] ? &ground.building_ids[o] : nullptr;
    };
    const auto differs = [&](std::size_t p, std::size_t q) {
        const std::string *a = group(p), *b = group(q);
        return a && (!b || *a != *b);
    };
    for (int r = 0; r < view.height; ++r) {
        for (int c = 0; c < view.width; ++c) {
            const std::size_t p = static_cast<std::size_t>(r) * view.width + c;
            const std::uint32_t object = view.object[p];
            if (object == PlanView::kNothing) continue;
            const bool is_house = ground.is_building[object], is_plan = ground.is_planned[object];
            const bool is_rim = (c > 0 && differs(p, p - 1)) || (c + 1 < view.width && differs(p, p + 1)) ||
                                (r > 0 && differs(p, p - view.width)) ||
                                (r + 1 < view.height && differs(p, p + view.width));
            pixels[p] = !is_house ? kGround : is_rim ? (is_plan ? kPlanRim : kRim) : is_plan ? kPlan : kHouse;
        }
    }
    return pixels;
}

std::string framed_map_svg(const MapGround& ground, const std::vector<Rgb8>& pixels, const std::string& inside,
                           const std::string& legend, double legend_height, double convergence_rad, double lettering) {
    const PlanView& view = ground.view;
    const double scale = 1000.0 / std::max(view.width, view.height);  // units a pixel
    const double width = scale * view.width, height = scale * view.height;
    Image8 image{view.width, view.height, 3, {}};
    for (const Rgb8& pixel : pixels) image.pixels.insert(image.pixels.end(), pixel.begin(), pixel.end());
    const double metre = scale / view.pixel_m;  // units
    std::string out = fmt::format(
        "<svg class=\"map\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1000 {:.1f}\" font-size=\"17\" "
        "role=\"img\">",
        height + 12.0 + lettering * (legend_height + 40.0));
    out += fmt::format(
        "<image x=\"0\" y=\"0\" width=\"{:.1f}\" height=\"{:.1f}\" preserveAspectRatio=\"none\" href=\"{}\"/>", width,
        height, data_uri("image/png", encode_png(image)));
    if (!inside.empty()) {
        out += fmt::format(
            "<svg x=\"0\" y=\"0\" width=\"{0:.1f}\" height=\"{1:.1f}\"><g transform=\"scale({2:.6f})\">{3}</g></svg>",
            width, height, metre, inside);
    }
    out += fmt::format("<rect x=\"0.5\" y=\"0.5\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#444\"/>",
                       width - 1.0, height - 1.0);
    // True north lies `convergence` west of the grid's where that is positive: azimuth of the grid = true −
    // convergence.
    out += fmt::format(
        "<g transform=\"translate({:.1f} {:.1f}) scale({:.2f}) rotate({:.3f})\"><circle r=\"40\" fill=\"#fff\" "
        "fill-opacity=\"0.8\"/>"
        "<path d=\"M0 -26L10 18L0 9L-10 18Z\" fill=\"#222\"/>"
        "<text y=\"-27\" text-anchor=\"middle\" font-weight=\"bold\" font-size=\"15\">N</text></g>",
        width - 52.0 * lettering, 52.0 * lettering, lettering, -convergence_rad * 180.0 / kPi);
    const double length_m = round_length(0.3 * 1000.0 / metre);
    const double bar = length_m * metre / lettering;
    const double top = height + 14.0;
    out += fmt::format("<g transform=\"translate(0 {:.1f}) scale({:.2f})\">", top, lettering);
    for (int part = 0; part < 4; ++part) {
        out += fmt::format("<rect x=\"{:.1f}\" y=\"6\" width=\"{:.1f}\" height=\"8\" fill=\"{}\" stroke=\"#222\"/>",
                           30.0 + 0.25 * part * bar, 0.25 * bar, part % 2 ? "#fff" : "#222");
    }
    out += text_svg(30.0, 32.0, "middle", false, "0");
    out += text_svg(30.0 + bar, 32.0, "middle", false, fmt::format("{:g} m", length_m));
    out += fmt::format("<g transform=\"translate(0 40)\">{}</g></g></svg>", legend);
    return out;
}

std::string study_map_svg(const StudyMap& map, const Words& words) {
    std::vector<Rgb8> pixels = ground_pixels(*map.ground);
    Painter(map, pixels).paint();
    return framed_map_svg(*map.ground, pixels, "", legend_svg(map, words), 60.0, map.convergence_rad, map.lettering);
}

}  // namespace skybake::io
