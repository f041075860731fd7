#include "io/study/shadow_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "io/study/stepped_scale.h"
#include "io/study/study_map.h"
#include "io/xml/xml_text.h"

namespace skybake::io {
namespace {

/// An outline as a path in metres east and south of the view's north-west corner.
std::string path_of(const ShadowOutline& outline, const PlanView& view) {
    std::string path;
    for (const std::vector<Vec2d>& ring : outline.rings) {
        char letter = 'M';
        for (const Vec2d& p : ring) {
            fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", letter, p.x - view.lo.x, view.hi().y - p.y);
            letter = 'L';
        }
        path += 'Z';
    }
    return path;
}

/// Morning blue over noon green to evening red: a colour a shadow.
Rgb8 colour_of_hour(double share) {
    constexpr Rgb8 kMorning{33, 102, 172}, kNoon{27, 120, 55}, kEvening{178, 24, 43};
    const Rgb8 &a = share < 0.5 ? kMorning : kNoon, &b = share < 0.5 ? kNoon : kEvening;
    const double t = share < 0.5 ? 2.0 * share : 2.0 * share - 1.0;
    Rgb8 colour{};
    for (int k = 0; k < 3; ++k) colour[k] = static_cast<std::uint8_t>(a[k] + t * (b[k] - a[k]));
    return colour;
}

std::string clock_note(bool is_solar, const Words& words) {
    return is_solar ? words("true solar time", "wahre Ortszeit") : words("local time", "Ortszeit");
}

}  // namespace

std::string shadow_fan_svg(const StudyPictures& pictures, const MapGround& map, std::size_t day, ShadowKind lines,
                           ShadowKind tint, const Words& words, double convergence_rad) {
    std::vector<const HourShadow*> hours;
    std::string tints, strokes, legend;
    for (const HourShadow& shadow : pictures.shadows) {
        if (shadow.day != day || shadow.outline.rings.empty()) continue;
        if (shadow.kind == lines) hours.push_back(&shadow);
        if (shadow.kind == tint)
            tints += fmt::format("<path d=\"{}\" fill=\"#d95f0e\" fill-opacity=\"0.16\" fill-rule=\"evenodd\"/>",
                                 path_of(shadow.outline, map.view));
    }
    if (hours.empty()) return "";
    const double width = std::min(80.0, 760.0 / static_cast<double>(hours.size()));
    const double line_m = 1.5e-3 * map.view.pixel_m * std::max(map.view.width, map.view.height);
    for (std::size_t i = 0; i < hours.size(); ++i) {
        const double share = hours.size() > 1 ? static_cast<double>(i) / static_cast<double>(hours.size() - 1) : 0.5;
        const std::string colour = hex_of(colour_of_hour(share));
        strokes += fmt::format(
            "<path d=\"{}\" fill=\"{}\" fill-opacity=\"0.05\" fill-rule=\"evenodd\" stroke=\"{}\" "
            "stroke-width=\"{:.3f}\" stroke-linejoin=\"round\"/>",
            path_of(hours[i]->outline, map.view), colour, colour, line_m);
        const double x = 30.0 + width * static_cast<double>(i);
        legend +=
            fmt::format("<path d=\"M{:.1f} 22h{:.1f}\" stroke=\"{}\" stroke-width=\"5\"/>", x, width - 12.0, colour);
        legend += fmt::format("<text x=\"{:.1f}\" y=\"44\" text-anchor=\"middle\" font-size=\"15\">{}</text>",
                              x + 0.5 * (width - 12.0), xml_text(hours[i]->clock));
    }
    legend +=
        fmt::format("<text x=\"{:.1f}\" y=\"44\" font-size=\"15\">{}</text>",
                    34.0 + width * static_cast<double>(hours.size()), clock_note(pictures.has_solar_clock, words));
    return framed_map_svg(map, ground_pixels(map), tints + strokes, legend, 56.0, convergence_rad, 1.0);
}

std::string shadow_instant_svg(const HourShadow& shadow, const MapGround& map, const Words& words,
                               double convergence_rad) {
    const std::string inside =
        fmt::format("<path d=\"{}\" fill=\"#223355\" fill-opacity=\"0.45\" fill-rule=\"evenodd\"/>",
                    path_of(shadow.outline, map.view));
    const std::string legend = fmt::format(
        "<rect x=\"30\" y=\"12\" width=\"40\" height=\"22\" fill=\"#223355\" fill-opacity=\"0.45\" stroke=\"#444\"/>"
        "<text x=\"80\" y=\"30\">{}</text>",
        xml_text(words("shadow on the ground", "Schatten auf dem Boden")));
    return framed_map_svg(map, ground_pixels(map), inside, legend, 44.0, convergence_rad, 2.0);
}

}  // namespace skybake::io
