// A study's numbers on a map.
#pragma once

#include <string>
#include <vector>

#include "io/study/report_words.h"
#include "io/study/stepped_scale.h"
#include "study/study_pictures.h"

namespace skybake::io {

struct StudyMap {
    const MapGround* ground = nullptr;
    const ReceiverSet* receivers = nullptr;
    const std::vector<float>* values = nullptr;  // one a sample; NaN is not drawn
    SteppedScale scale;
    bool shows_worst_low = true;  // where cells lie above each other: the least value is on top, else the greatest
    std::string unit;
    int decimals = 2;
    double convergence_rad = 0.0;  // from grid to true north
    double lettering = 1.0;        // scale of legend, arrow and bar
};

/// Pixels of the map's ground: buildings grey with darker rims, what is planned violet, all else white.
std::vector<Rgb8> ground_pixels(const MapGround& ground);

/// The map as SVG: a picture of the cells, legend with the class edges (thresholds in bold), arrow to true north, scale
/// bar.
std::string study_map_svg(const StudyMap& map, const Words& words);

/// The frame of any map: `inside` is SVG in metres east and south of the view's north-west corner; `legend` stands
/// below, `legend_height` units high, the map being 1,000 wide or, where it is higher than wide, 1,000 high.
std::string framed_map_svg(const MapGround& ground, const std::vector<Rgb8>& pixels, const std::string& inside,
                           const std::string& legend, double legend_height, double convergence_rad, double lettering);

}  // namespace skybake::io
