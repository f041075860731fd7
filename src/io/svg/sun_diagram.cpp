#include "io/svg/sun_diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "io/file/replace_file.h"
#include "io/xml/xml_text.h"

namespace skybake::io {
namespace {

// Layout, in units of the picture. At 600 pixels of width a unit is half a pixel, so no text is below 20 units.
constexpr double kWidth = 1200.0;
constexpr double kRadius = 430.0;         // of the horizon
constexpr double kDateRadius = 480.0;     // middle of the dates
constexpr double kRingRadius = 526.0;     // of the compass ring about them
constexpr double kCompassRadius = 557.0;  // middle of the azimuths
constexpr double kTitleSize = 34.0;
constexpr double kTextSize = 22.0;
constexpr double kSmallSize = 20.0;
constexpr double kMargin = 20.0;

constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};

std::string day_text(CalendarDay day) {
    return fmt::format("{} {}", day.day, kMonths[day.month - 1]);
}

/// What a text takes up. Widths are those of DejaVu Sans, the widest of the fonts that are asked for: 0.64 of the size
/// a letter on average, 0.72 in bold.
struct Box {
    Vec2d middle;
    Vec2d half;
    bool touches(const Box& other) const {
        return std::abs(middle.x - other.middle.x) < half.x + other.half.x &&
               std::abs(middle.y - other.middle.y) < half.y + other.half.y;
    }
};

std::size_t characters(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

enum class Weight { normal, bold };

Box box_of(std::string_view text, double size, Weight weight, const Vec2d& middle) {
    const double letter = weight == Weight::bold ? 0.72 : 0.64;
    return {middle, {0.5 * letter * size * static_cast<double>(characters(text)) + 2.0, 0.55 * size}};
}

class Drawing {
  public:
    explicit Drawing(const SunDiagram& diagram) : diagram_(diagram) {
        const double head =
            kMargin + 1.3 * kTitleSize + 1.35 * kTextSize * static_cast<double>(diagram.subtitles.size());
        middle_ = {0.5 * kWidth, head + kMargin + kCompassRadius + kTextSize};
        notes_top_ = middle_.y + kCompassRadius + 2.0 * kTextSize + kMargin;
        height_ = notes_top_ + 1.35 * kSmallSize * static_cast<double>(diagram.notes.size()) + kMargin;
    }

    std::string draw() {
        out_ += fmt::format(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
            "height=\"{1:.0f}\" font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\" role=\"img\">\n"
            "<title>{2}</title>\n"
            "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
            kWidth, height_, xml_text(diagram_.title));
        head();
        obstructions();
        grid();
        hours();
        days();
        marks();
        // Marks choose their places first, then what is fixed to a line; last the scale, which has most freedom.
        mark_labels();
        day_labels();
        hour_labels();
        elevation_labels();
        out_ += labels_ + "</svg>\n";
        return std::move(out_);
    }

  private:
    Vec2d at(const SunPathPoint& point) const {
        return middle_ + kRadius * disc_point(diagram_.projection, point.azimuth_rad, point.elevation_rad);
    }
    /// A point beside the disc, towards an azimuth.
    Vec2d beside(double azimuth_rad, double radius) const {
        return middle_ + radius * Vec2d(std::sin(azimuth_rad), -std::cos(azimuth_rad));
    }

    /// Text about its middle, in a group's style; `y` is corrected from the middle to the baseline.
    static std::string text(std::string_view content, const Vec2d& middle, double size, const char* attributes) {
        return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.0f}\" text-anchor=\"middle\" {}>{}</text>\n",
                           middle.x, middle.y + 0.36 * size, size, attributes, xml_text(content));
    }

    /// Writes a label at the first of the places where it lies on no other, if there is one.
    bool label(std::string_view content, double size, Weight weight, const char* attributes,
               const std::vector<Vec2d>& places) {
        for (const Vec2d& place : places) {
            const Box box = box_of(content, size, weight, place);
            if (box.middle.x - box.half.x < 0.0 || box.middle.x + box.half.x > kWidth) continue;
            if (std::any_of(taken_.begin(), taken_.end(), [&](const Box& other) { return box.touches(other); }))
                continue;
            taken_.push_back(box);
            labels_ += text(content, place, size, attributes);
            return true;
        }
        return false;
    }

    void head() {
        double y = kMargin + 0.65 * kTitleSize;
        out_ += text(diagram_.title, {0.5 * kWidth, y}, kTitleSize, "font-weight=\"bold\" fill=\"#111111\"");
        y += kTitleSize;
        for (const std::string& line : diagram_.subtitles) {
            out_ += text(line, {0.5 * kWidth, y}, kTextSize, "fill=\"#333333\"");
            y += 1.35 * kTextSize;
        }
        y = notes_top_;
        for (const std::string& line : diagram_.notes) {
            out_ += text(line, {0.5 * kWidth, y}, kSmallSize, "fill=\"#444444\"");
            y += 1.35 * kSmallSize;
        }
    }

    void stroke(const Vec2d& from, const Vec2d& to) {
        out_ += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", from.x, from.y, to.x, to.y);
    }

    void grid() {
        out_ += "<g id=\"grid\" fill=\"none\" stroke=\"#b8b8b8\" stroke-width=\"1\">\n";
        for (int azimuth = 0; azimuth < 360; azimuth += 10) {
            const double radians = radians_from_degrees(azimuth);
            const bool is_labelled = azimuth % 30 == 0;
            stroke(beside(radians, kRingRadius), beside(radians, kRingRadius - (is_labelled ? 12.0 : 7.0)));
            if (is_labelled) stroke(middle_, beside(radians, kRadius));
        }
        for (int elevation = 10; elevation < 90; elevation += 10) {
            const double radius =
                kRadius * disc_point(diagram_.projection, 0.5 * kPi, radians_from_degrees(elevation)).x;
            out_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>\n", middle_.x, middle_.y, radius);
        }
        out_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>\n", middle_.x, middle_.y, kRingRadius);
        out_ += fmt::format(
            "<circle id=\"horizon\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" stroke=\"#222222\" "
            "stroke-width=\"2.5\"/>\n"
            "</g>\n<g id=\"compass\">\n",
            middle_.x, middle_.y, kRadius);
        constexpr std::array<const char*, 4> kWinds = {"N", "E", "S", "W"};
        for (int azimuth = 0; azimuth < 360; azimuth += 30) {
            const Vec2d place = beside(radians_from_degrees(azimuth), kCompassRadius);
            const bool is_wind = azimuth % 90 == 0;
            const std::string name =
                is_wind ? kWinds[static_cast<std::size_t>(azimuth / 90)] : fmt::format("{}°", azimuth);
            const double size = is_wind ? 32.0 : kTextSize;
            out_ += text(name, place, size, is_wind ? "font-weight=\"bold\" fill=\"#111111\"" : "fill=\"#333333\"");
            taken_.push_back(box_of(name, size, is_wind ? Weight::bold : Weight::normal, place));
        }
        out_ += "</g>\n";
    }

    void obstructions() {
        for (const SkyShade& shade : diagram_.shades) {
            std::string path;
            for (const SkyPatch& patch : shade.patches) {
                const auto corner = [&](double azimuth, double elevation) { return at({azimuth, elevation}); };
                const Vec2d a = corner(patch.azimuth_begin_rad, patch.elevation_begin_rad);
                const Vec2d b = corner(patch.azimuth_end_rad, patch.elevation_begin_rad);
                const Vec2d c = corner(patch.azimuth_end_rad, patch.elevation_end_rad);
                const Vec2d d = corner(patch.azimuth_begin_rad, patch.elevation_end_rad);
                fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z",
                               a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y);
            }
            // The stroke closes the seams between neighbouring patches.
            out_ += fmt::format("<path class=\"shade\" fill=\"{0}\" stroke=\"{0}\" stroke-width=\"0.6\" d=\"{1}\"/>\n",
                                xml_text(shade.colour), path);
        }
    }

    void lines(const std::vector<SunPathLine>& parts) {
        for (const SunPathLine& line : parts) {
            if (line.size() < 2) continue;
            std::string path;
            for (const SunPathPoint& point : line) {
                const Vec2d p = at(point);
                fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", path.empty() ? "M" : "L", p.x, p.y);
            }
            out_ += fmt::format("<path d=\"{}\"/>\n", path);
        }
    }

    void hours() {
        out_ += "<g id=\"hours\" fill=\"none\" stroke=\"#2c7fb8\" stroke-width=\"1.6\">\n";
        for (const HourLine& hour : diagram_.hours) lines(hour.spring);
        out_ += "<g stroke-dasharray=\"7 5\">\n";
        for (const HourLine& hour : diagram_.hours) lines(hour.autumn);
        out_ += "</g>\n</g>\n";
    }

    void days() {
        out_ += "<g id=\"days\" fill=\"none\" stroke=\"#444444\" stroke-width=\"2\">\n";
        for (const DayArc& day : diagram_.days) lines(day.lines);
        out_ += "</g>\n<g id=\"chosen-days\" fill=\"none\" stroke=\"#d95f0e\" stroke-width=\"3\">\n";
        for (const DayArc& day : diagram_.chosen_days) lines(day.lines);
        out_ += "</g>\n";
    }

    void marks() {
        out_ += "<g id=\"marks\" fill=\"#d95f0e\" stroke=\"#ffffff\" stroke-width=\"2\">\n";
        for (const SunMark& mark : diagram_.marks) {
            const Vec2d p = at({mark.azimuth_rad, mark.elevation_rad});
            out_ +=
                fmt::format("<circle class=\"mark\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"9\"><title>{}</title></circle>\n",
                            p.x, p.y, xml_text(mark.label));
            taken_.push_back({p, Vec2d(9.0)});
        }
        out_ += "</g>\n";
    }

    static constexpr const char* kHalo =
        "paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"5\" stroke-linejoin=\"round\"";

    void mark_labels() {
        const std::string style = fmt::format("class=\"mark-label\" font-weight=\"bold\" fill=\"#a63603\" {}", kHalo);
        for (const SunMark& mark : diagram_.marks) {
            const Vec2d p = at({mark.azimuth_rad, mark.elevation_rad});
            const Vec2d half = box_of(mark.label, kTextSize, Weight::bold, p).half + Vec2d(12.0, 10.0);
            std::vector<Vec2d> places;
            for (const double reach : {1.0, 1.6}) {
                for (const auto& [x, y] :
                     {std::pair{0.0, -1.0}, std::pair{0.0, 1.0}, std::pair{1.0, 0.0}, std::pair{-1.0, 0.0},
                      std::pair{0.8, -1.0}, std::pair{-0.8, -1.0}, std::pair{0.8, 1.0}, std::pair{-0.8, 1.0}}) {
                    places.push_back(p + Vec2d(reach * x * half.x, reach * y * half.y));
                }
            }
            label(mark.label, kTextSize, Weight::bold, style.c_str(), places);
        }
    }

    /// Beside the horizon where the arc meets it: the day at sunset, its twin at sunrise. Arcs that never do, in polar
    /// day, have theirs about the azimuth of midnight, each farther from it than the lower ones, with a line to the
    /// arc.
    void day_labels() {
        out_ += "<g id=\"ticks\" fill=\"none\" stroke=\"#444444\" stroke-width=\"2\">\n";
        int polar = 0;
        for (const DayArc& day : diagram_.days) {
            const std::string name = day_text(day.day);
            const std::string twin = day.twin ? day_text(*day.twin) : name;
            if (day.kind == SolarDayKind::midnight_sun && !day.lines.empty()) {
                const SunPathLine& line = day.lines.front();
                const SunPathPoint lowest = *std::min_element(
                    line.begin(), line.end(),
                    [](const SunPathPoint& a, const SunPathPoint& b) { return a.elevation_rad < b.elevation_rad; });
                const double aside = radians_from_degrees(7.0 + 14.0 * polar++);
                const double west = std::cos(lowest.azimuth_rad) > 0.0 ? -1.0 : 1.0;
                date(lowest.azimuth_rad + west * aside, name, at(nearest(line, lowest.azimuth_rad + west * aside)));
                date(lowest.azimuth_rad - west * aside, twin, at(nearest(line, lowest.azimuth_rad - west * aside)));
                continue;
            }
            // A way that the solar day's midnight cuts meets the horizon inside the list.
            for (const SunPathLine& line : day.lines) {
                const SunPathPoint& rise = line.front();
                const SunPathPoint& set = line.back();
                if (rise.elevation_rad <= 0.0) date(rise.azimuth_rad, twin, beside(rise.azimuth_rad, kRadius));
                if (set.elevation_rad <= 0.0) date(set.azimuth_rad, name, beside(set.azimuth_rad, kRadius));
            }
        }
        out_ += "</g>\n";
    }

    static const SunPathPoint& nearest(const SunPathLine& line, double azimuth_rad) {
        const auto apart = [&](const SunPathPoint& point) {
            return std::abs(std::remainder(point.azimuth_rad - azimuth_rad, 2.0 * kPi));
        };
        return *std::min_element(line.begin(), line.end(),
                                 [&](const SunPathPoint& a, const SunPathPoint& b) { return apart(a) < apart(b); });
    }

    void date(double azimuth_rad, const std::string& content, const Vec2d& arc_end) {
        const std::string style = fmt::format("class=\"day\" fill=\"#222222\" {}", kHalo);
        std::vector<Vec2d> places;
        for (int step = 0; step <= 12; ++step) {
            for (const int side : {1, -1})
                places.push_back(beside(azimuth_rad + side * radians_from_degrees(0.5 * step), kDateRadius));
        }
        if (label(content, kTextSize, Weight::normal, style.c_str(), places))
            stroke(arc_end, beside(azimuth_rad, kRadius + 14.0));
    }

    /// At the solstices' ends of the hour's line, or else where there is room along it.
    void hour_labels() {
        const std::string style = fmt::format("class=\"hour\" fill=\"#08519c\" {}", kHalo);
        for (const HourLine& hour : diagram_.hours) {
            std::vector<Vec2d> places;
            const auto add_line = [&](const SunPathLine& line) {
                const std::size_t inner =
                    std::max<std::size_t>(1, line.size() / 6);  // across the loop's end, not along it
                for (const auto& [end, next] :
                     {std::pair{line.back(), line[line.size() - 1 - inner]}, std::pair{line.front(), line[inner]}}) {
                    const Vec2d p = at(end);
                    const Vec2d outward = p - at(next);
                    const double length = std::hypot(outward.x, outward.y);
                    if (length > 0.0 && end.elevation_rad > radians_from_degrees(3.0))
                        places.push_back(p + outward / length * 18.0);
                }
            };
            for (const SunPathLine& line : hour.spring) {
                if (line.size() > 1) add_line(line);
            }
            for (const auto* half : {&hour.spring, &hour.autumn}) {
                for (const SunPathLine& line : *half) {
                    for (std::size_t i = 2; i + 2 < line.size(); i += 4) places.push_back(at(line[i]));
                }
            }
            std::erase_if(places, [&](const Vec2d& p) { return glm::length(p - middle_) > kRadius - 14.0; });
            label(std::to_string(hour.hour), kTextSize, Weight::normal, style.c_str(), places);
        }
    }

    void elevation_labels() {
        const std::string style = fmt::format("class=\"elevation\" fill=\"#666666\" {}", kHalo);
        for (int elevation = 10; elevation <= 80; elevation += 10) {
            std::vector<Vec2d> places;
            for (const int azimuth : {0, 180, 15, 345, 165, 195, 45, 315, 135, 225, 75, 285, 105, 255})
                places.push_back(at({radians_from_degrees(azimuth), radians_from_degrees(elevation)}));
            label(fmt::format("{}°", elevation), kSmallSize, Weight::normal, style.c_str(), places);
        }
    }

    const SunDiagram& diagram_;
    Vec2d middle_{0.0};
    double notes_top_ = 0.0;
    double height_ = 0.0;
    std::string out_;
    std::string labels_;  // above all lines
    std::vector<Box> taken_;
};

}  // namespace

Vec2d disc_point(DomeProjection projection, double azimuth_rad, double elevation_rad) {
    const double zenith = 0.5 * kPi - elevation_rad;
    double radius = 0.0;
    switch (projection) {
        case DomeProjection::stereographic:
            radius = std::tan(0.5 * zenith);
            break;
        case DomeProjection::equidistant:
            radius = zenith / (0.5 * kPi);
            break;
        case DomeProjection::orthographic:
            radius = std::sin(zenith);
            break;
    }
    return radius * Vec2d(std::sin(azimuth_rad), -std::cos(azimuth_rad));
}

std::string sun_diagram_svg(const SunDiagram& diagram) {
    return Drawing(diagram).draw();
}

void write_sun_diagram(const std::filesystem::path& path, const SunDiagram& diagram) {
    const std::string svg = sun_diagram_svg(diagram);
    FileReplacement file(path);
    file.write(svg);
    file.commit();
}

}  // namespace skybake::io
