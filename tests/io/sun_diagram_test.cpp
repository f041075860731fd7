#include "io/svg/sun_diagram.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include "base/error.h"
#include "io/scratch_folder.h"
#include "sky/solar_position.h"

namespace skybake {
namespace {

using io::disc_point;
using io::DomeProjection;
using ::testing::HasSubstr;

struct Element {
    std::string name;
    std::map<std::string, std::string> attributes;
    std::string text;
};

/// The elements of a well-formed XML text of the kind that is written here: elements, attributes in double quotes and
/// text, with the five named entities. Anything else fails the test.
std::vector<Element> parsed(const std::string& xml) {
    std::vector<Element> elements;
    std::vector<std::size_t> open;
    std::size_t at = xml.find("?>");
    EXPECT_EQ(xml.rfind("<?xml version=\"1.0\" encoding=\"UTF-8\"?>", 0), 0u);
    at += 2;
    const auto unescaped = [](std::string text) {
        EXPECT_EQ(text.find_first_of("<>"), std::string::npos) << text;
        for (std::size_t amp = 0; (amp = text.find('&', amp)) != std::string::npos; ++amp) {
            bool is_known = false;
            for (const auto& [entity, letter] :
                 {std::pair{"&amp;", "&"}, std::pair{"&lt;", "<"}, std::pair{"&gt;", ">"}, std::pair{"&quot;", "\""}}) {
                if (text.compare(amp, std::strlen(entity), entity) != 0) continue;
                text.replace(amp, std::strlen(entity), letter);
                is_known = true;
                break;
            }
            EXPECT_TRUE(is_known) << text;
        }
        return text;
    };
    while (at < xml.size()) {
        const std::size_t less = xml.find('<', at);
        const std::string between = xml.substr(at, less - at);
        if (!open.empty()) {
            elements[open.back()].text += unescaped(between);
        } else {
            EXPECT_EQ(between.find_first_not_of("\n"), std::string::npos) << "text outside the root";
        }
        if (less == std::string::npos) break;
        const std::size_t greater = xml.find('>', less);
        std::string tag = xml.substr(less + 1, greater - less - 1);
        at = greater + 1;
        if (tag[0] == '/') {
            EXPECT_FALSE(open.empty());
            EXPECT_EQ(elements[open.back()].name, tag.substr(1));
            open.pop_back();
            continue;
        }
        const bool is_closed = tag.back() == '/';
        if (is_closed) tag.pop_back();
        Element element;
        std::istringstream stream(tag);
        stream >> element.name;
        std::string rest;
        std::getline(stream, rest);
        for (std::size_t p = 0; (p = rest.find_first_not_of(' ', p)) != std::string::npos;) {
            const std::size_t equals = rest.find("=\"", p);
            const std::size_t end = rest.find('"', equals + 2);
            if (equals == std::string::npos || end == std::string::npos) {
                ADD_FAILURE() << tag;
                return elements;
            }
            const bool is_new =
                element.attributes
                    .emplace(rest.substr(p, equals - p), unescaped(rest.substr(equals + 2, end - equals - 2)))
                    .second;
            EXPECT_TRUE(is_new) << "an attribute twice: " << tag;
            p = end + 1;
        }
        elements.push_back(element);
        if (!is_closed) open.push_back(elements.size() - 1);
    }
    EXPECT_TRUE(open.empty());
    return elements;
}

double number(const Element& element, const std::string& name) {
    return std::stod(element.attributes.at(name));
}

io::SunDiagram diagram_of(double latitude_deg, double longitude_deg, std::optional<int> clock, int marks_an_hour = 0) {
    const Site site{radians_from_degrees(latitude_deg), radians_from_degrees(longitude_deg), 0.0};
    io::SunDiagram diagram;
    diagram.title = "Sun path";
    diagram.days = year_arcs(2026, site);
    diagram.hours = hour_lines(2026, site, clock);
    for (int i = 0; i < 24 * marks_an_hour; ++i) {
        const UtcTime time{utc_midnight(2026, 5, 3).milliseconds + i * 3'600'000 / marks_an_hour};
        const SolarPosition sun = solar_position(time, site);
        if (sun.apparent_elevation_rad > 0.0)
            diagram.marks.push_back({fmt::format("3 May {}", to_iso8601({time, 0}).substr(11, 5)), sun.azimuth_rad,
                                     sun.apparent_elevation_rad});
    }
    return diagram;
}

// Truth: the projections' formulas; north is up, east on the right.
TEST(DiscPoint, FollowsTheFormulas) {
    const double pi = std::acos(-1.0);
    for (const auto projection :
         {DomeProjection::stereographic, DomeProjection::equidistant, DomeProjection::orthographic}) {
        EXPECT_NEAR(glm::length(disc_point(projection, 1.0, 0.0)), 1.0, 1e-12);
        EXPECT_NEAR(glm::length(disc_point(projection, 1.0, pi / 2.0)), 0.0, 1e-12);
        EXPECT_NEAR(disc_point(projection, 0.0, 0.0).y, -1.0, 1e-12);
        EXPECT_NEAR(disc_point(projection, pi / 2.0, 0.0).x, 1.0, 1e-12);
    }
    EXPECT_NEAR(disc_point(DomeProjection::stereographic, pi / 2.0, pi / 4.0).x, std::sqrt(2.0) - 1.0, 1e-12);
    EXPECT_NEAR(disc_point(DomeProjection::equidistant, pi / 2.0, pi / 4.0).x, 0.5, 1e-12);
    EXPECT_NEAR(disc_point(DomeProjection::orthographic, pi / 2.0, pi / 4.0).x, std::sqrt(0.5), 1e-12);
}

// Truth: the stereographic formula about the circle that is drawn as the horizon.
TEST(SunDiagramSvg, MarksStandWhereTheFormulaSays) {
    io::SunDiagram diagram = diagram_of(47.07, 15.44, 60);
    diagram.marks = {{"09:00", radians_from_degrees(94.6725), radians_from_degrees(37.1525)}};
    const std::vector<Element> elements = parsed(sun_diagram_svg(diagram));
    const Element* horizon = nullptr;
    const Element* mark = nullptr;
    int lines = 0;
    for (const Element& element : elements) {
        if (element.name == "path") ++lines;
        if (element.name != "circle") continue;
        const auto id = element.attributes.find("id");
        if (id != element.attributes.end() && id->second == "horizon") horizon = &element;
        if (element.attributes.contains("class")) mark = &element;
    }
    ASSERT_TRUE(horizon && mark);
    EXPECT_GT(lines, 7 + 2 * 14);
    const double pi = std::acos(-1.0);
    const double radius = number(*horizon, "r") * std::tan((90.0 - 37.1525) / 2.0 * pi / 180.0);
    EXPECT_NEAR(number(*mark, "cx") - number(*horizon, "cx"), radius * std::sin(94.6725 * pi / 180.0), 0.02);
    EXPECT_NEAR(number(*mark, "cy") - number(*horizon, "cy"), -radius * std::cos(94.6725 * pi / 180.0), 0.02);
}

TEST(SunDiagramSvg, LabelsCompassDaysHoursAndElevations) {
    const std::string svg = sun_diagram_svg(diagram_of(47.07, 15.44, 60));
    for (const char* text : {">N<", ">E<", ">S<", ">W<", ">30°<", ">330°<", ">21 Jun<", ">21 Dec<", ">20 Mar<",
                             ">23 Sep<", ">22 Jul<", ">12<", ">8<", ">10°<", ">60°<"}) {
        EXPECT_THAT(svg, HasSubstr(text));
    }
    // Polar day and night: the days that never set have their names, too, those without sun none.
    const std::string barrow = sun_diagram_svg(diagram_of(71.3, -156.8, -540));
    EXPECT_THAT(barrow, HasSubstr(">21 May<"));
    EXPECT_THAT(barrow, HasSubstr(">21 Jul<"));
    EXPECT_THAT(barrow, ::testing::Not(HasSubstr(">21 Dec<")));
}

// Truth: widths of DejaVu Sans, whose digits and letters take 0.6 of the size on average, whose bold ones 0.69. No text
// may touch another, from pole to pole and with more marks than there is room for.
TEST(SunDiagramSvg, NoTextLiesOnAnother) {
    struct Box {
        double x, y, half_width, half_height;
        std::string text;
    };
    for (const double latitude : {90.0, 77.8, 71.3, 66.5, 60.0, 47.07, 23.44, 1.37, 0.0, -33.9, -54.8, -77.85}) {
        for (const int marks_an_hour : {0, 1, 4}) {
            SCOPED_TRACE(latitude);
            std::vector<Box> boxes;
            for (const Element& element : parsed(sun_diagram_svg(diagram_of(
                     latitude, 20.0, marks_an_hour == 1 ? std::nullopt : std::optional(60), marks_an_hour)))) {
                if (element.name != "text") continue;
                const double size = number(element, "font-size");
                EXPECT_GE(size, 20.0);
                const auto letters = static_cast<double>(
                    std::count_if(element.text.begin(), element.text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
                const double width = (element.attributes.contains("font-weight") ? 0.69 : 0.6) * size * letters;
                boxes.push_back({number(element, "x"), number(element, "y"), 0.5 * width, 0.36 * size, element.text});
                EXPECT_GE(boxes.back().x - boxes.back().half_width, 0.0) << element.text;
                EXPECT_LE(boxes.back().x + boxes.back().half_width, 1200.0) << element.text;
            }
            EXPECT_GT(boxes.size(), 15u);
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    const bool touches =
                        std::abs(boxes[i].x - boxes[j].x) < boxes[i].half_width + boxes[j].half_width &&
                        std::abs(boxes[i].y - boxes[j].y) < boxes[i].half_height + boxes[j].half_height;
                    EXPECT_FALSE(touches) << boxes[i].text << " on " << boxes[j].text;
                }
            }
        }
    }
}

TEST(SunDiagramSvg, EscapesTextAndWritesWhole) {
    io::SunDiagram diagram = diagram_of(47.07, 15.44, std::nullopt);
    diagram.title = "R&D <site> \"x\" \x01 Größe";
    diagram.marks = {{"<&>", 1.0, 1.0}};
    const std::string svg = sun_diagram_svg(diagram);
    EXPECT_THAT(svg, HasSubstr("R&amp;D &lt;site&gt; &quot;x&quot;   Größe"));
    bool has_mark_label = false;
    for (const Element& element : parsed(svg)) has_mark_label |= element.name == "text" && element.text == "<&>";
    EXPECT_TRUE(has_mark_label);

    const ScratchFolder folder("sun-diagram");
    io::write_sun_diagram(folder / "d.svg", diagram);
    std::stringstream written;
    written << std::ifstream(folder / "d.svg").rdbuf();
    EXPECT_EQ(written.str(), svg);
    EXPECT_FALSE(std::filesystem::exists(folder / "d.svg.part"));
    EXPECT_THROW(io::write_sun_diagram(folder / "absent" / "d.svg", diagram), InputError);
}

}  // namespace
}  // namespace skybake
