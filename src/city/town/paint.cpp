#include "city/town/paint.h"

#include "city/town/styles.h"

namespace skybake::town {

std::vector<NamedImage> paint_pictures(std::uint64_t) {
    std::vector<NamedImage> images;
    const char* names[] = {"facade_ochre",  "facade_cream",   "facade_rose",   "facade_green", "facade_grey",
                           "facade_yellow", "plaster_ochre",  "plaster_cream", "plaster_rose", "plaster_green",
                           "plaster_grey",  "plaster_yellow", "tiles_red",     "tiles_brown",  "tiles_old",
                           "cobbles",       "slabs",          "gravel",        "grass",        "water",
                           "masonry",       "church",         "copper",        "clock",        "glass"};
    const std::uint8_t rgb[][3] = {{222, 186, 120}, {236, 222, 190}, {220, 170, 150},
                                   {180, 196, 160}, {190, 190, 186}, {238, 214, 140}};
    const std::uint8_t others[][3] = {{168, 86, 60},   {140, 80, 60},   {150, 100, 80},  {130, 126, 120},
                                      {150, 145, 138}, {160, 150, 135}, {96, 120, 60},   {70, 95, 95},
                                      {150, 140, 125}, {230, 215, 175}, {120, 160, 140}, {220, 215, 200},
                                      {120, 140, 160}};
    for (int i = 0; i < static_cast<int>(Picture::count); ++i) {
        NamedImage image{std::string(names[i]) + ".png", 16, 16, {}};
        const std::uint8_t* c = i < 12 ? rgb[i % 6] : others[i - 12];
        for (int p = 0; p < 256; ++p) image.pixels.insert(image.pixels.end(), c, c + 3);
        images.push_back(std::move(image));
    }
    return images;
}

}  // namespace skybake::town
