// Sun-path diagrams as SVG pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/vec.h"
#include "sky/sun_path.h"

namespace skybake::io {

/// How the dome becomes a disc; the horizon is its rim.
enum class DomeProjection {
    stereographic,  // radius ∝ tan(zenith angle / 2): angles are kept
    equidistant,    // ∝ zenith angle
    orthographic    // ∝ sin(zenith angle): as seen from high above; equal areas are equal shares of horizontal light
};

/// The point of the unit disc for a direction of the dome: x to the east, y to the south, as pictures have it. Below
/// the horizon: outside the disc, but for the orthographic projection, which folds.
Vec2d disc_point(DomeProjection projection, double azimuth_rad, double elevation_rad);

struct SunMark {
    std::string label;
    double azimuth_rad = 0.0;
    double elevation_rad = 0.0;  // at or above the horizon
};

/// A piece of the dome between two azimuths, of a few degrees, and two elevations.
struct SkyPatch {
    double azimuth_begin_rad = 0.0, azimuth_end_rad = 0.0;
    double elevation_begin_rad = 0.0, elevation_end_rad = 0.0;
};

/// Parts of the sky that something hides, in one colour ("#rrggbb").
struct SkyShade {
    std::string colour;
    std::vector<SkyPatch> patches;
};

struct SunDiagram {
    std::string title;
    std::vector<std::string> subtitles;
    std::vector<std::string> notes;  // below the disc
    DomeProjection projection = DomeProjection::stereographic;
    std::vector<DayArc> days;         // labelled at sunset by their day, at sunrise by its twin
    std::vector<DayArc> chosen_days;  // emphasised, without label
    std::vector<HourLine> hours;
    std::vector<SunMark> marks;
    std::vector<SkyShade> shades;  // below all lines
};

/// A picture of 1200 units' width, to be shown at 600 pixels or more: north up, east to the right, as on a map.
/// Labels that find no free place are left out, so that no text lies on another. Strings may hold any UTF-8 text; it is
/// escaped.
std::string sun_diagram_svg(const SunDiagram& diagram);

/// The same as a file, beside and renamed. Throws InputError when it cannot be written.
void write_sun_diagram(const std::filesystem::path& path, const SunDiagram& diagram);

}  // namespace skybake::io
