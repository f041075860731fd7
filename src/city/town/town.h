// A procedural Central European old town: our embedded demo, and the source of benchmarks of any size.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "city/city_model.h"

namespace skybake {

enum class TownVariant : std::uint8_t {
    as_built,
    with_tower,  // the same town and one planned high-rise, "planned-tower", on a lawn that every town keeps free
};

struct TownOptions {
    /// Buildings of the town as built, landmarks among them; 10 … 100000. The planned tower comes on top.
    std::uint32_t buildings = 250;
    std::uint64_t seed = 0;
    TownVariant variant = TownVariant::as_built;
};

/// A picture that we painted: sRGB, three channels a pixel, row 0 on top.
struct NamedImage {
    std::string name;  // file name, "facade_ochre.png"
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;
};

/// A lantern under an opaque roof: its light goes down and to the sides.
struct StreetLamp {
    std::string id;
    Vec3d position{0.0};  // map coordinates
    double flux_lm = 0.0;
    double color_temperature_k = 2700.0;
};

struct Town {
    CityModel city;                  // EPSG:31256, whole millimetres; its textures name "textures/NAME" without a path
    std::vector<NamedImage> images;  // one for each of the city's textures, in the same order
    std::vector<StreetLamp> lamps;   // 4 to 6 m above the ground, about 25 m apart, outside of all walls
};

inline constexpr std::uint32_t kMinTownBuildings = 10;
inline constexpr std::uint32_t kMaxTownBuildings = 100'000;

/// Builds the town. Every building is one closed, outward oriented shell of planar faces (a church or a castle several,
/// as parts); no two buildings overlap; ground, streets, courts and water cover the town and a margin without overlap
/// in plan, but for the water above the river's bed. Same options, same bits, whatever the thread count. A larger town
/// of the same seed holds the smaller one: houses keep their ids and their geometry. Time and memory grow linearly,
/// about 10 kB a building. `options.buildings` must be in its range.
Town build_town(const TownOptions& options);

}  // namespace skybake
