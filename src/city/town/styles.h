// The town's pictures and how they lie on faces: which texture has which scale.
#pragma once

#include <cstdint>

#include "base/ids.h"
#include "city/town/object_builder.h"

namespace skybake::town {

inline constexpr int kFacadeColours = 6;
inline constexpr int kRoofTiles = 3;

/// Indices into the city's textures, in this order.
enum class Picture : std::uint8_t {
    facade_first = 0,                               // one a colour
    plaster_first = facade_first + kFacadeColours,  // the same colours without windows
    tiles_first = plaster_first + kFacadeColours,
    cobbles = tiles_first + kRoofTiles,
    slabs,
    gravel,
    grass,
    water,
    masonry,
    church,
    copper,
    clock,
    glass,
    count
};

inline TextureId id_of(Picture picture, int variant = 0) {
    return TextureId(static_cast<std::size_t>(picture) + static_cast<std::size_t>(variant));
}

// A façade picture shows three bays and five storeys, and above them plain plaster.
inline constexpr double kBayWidth = 2.6;
inline constexpr int kFacadeBays = 3;
inline constexpr double kGroundStorey = 3.9;
inline constexpr double kStorey = 3.2;
inline constexpr double kFacadeHeight = 20.0;
inline constexpr double kPlasterPeriod = 5.0;
inline constexpr double kTilePeriod = 3.0;
inline constexpr double kCobblePeriod = 4.0;
inline constexpr double kGrassPeriod = 12.0;
inline constexpr double kWaterPeriod = 12.0;
inline constexpr double kMasonryPeriod = 4.0;
inline constexpr double kCopperPeriod = 2.4;
inline constexpr double kGlassPeriod = 6.0;  // two bays of 3 m, two storeys of 3 m
inline constexpr double kChurchBay = 5.0;    // one window a bay
inline constexpr double kChurchHeight = 16.0;

}  // namespace skybake::town
