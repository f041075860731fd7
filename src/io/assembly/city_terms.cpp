#include "io/assembly/city_terms.h"

#include <algorithm>
#include <array>

namespace skybake::io {
namespace {

constexpr std::array kTypes{
    ObjectTerm{"Building", ObjectType::building},
    ObjectTerm{"BuildingPart", ObjectType::building_part},
    ObjectTerm{"BuildingInstallation", ObjectType::building_installation},
    ObjectTerm{"BuildingConstructiveElement", ObjectType::building_installation},
    ObjectTerm{"BuildingRoom", ObjectType::other, true},
    ObjectTerm{"BuildingFurniture", ObjectType::other, true},
    ObjectTerm{"BuildingStorey", ObjectType::other, true},
    ObjectTerm{"BuildingUnit", ObjectType::other, true},
    ObjectTerm{"IntBuildingInstallation", ObjectType::other, true},
    ObjectTerm{"Bridge", ObjectType::bridge},
    ObjectTerm{"BridgePart", ObjectType::bridge},
    ObjectTerm{"BridgeInstallation", ObjectType::bridge},
    ObjectTerm{"BridgeConstructionElement", ObjectType::bridge},
    ObjectTerm{"BridgeConstructiveElement", ObjectType::bridge},
    ObjectTerm{"BridgeRoom", ObjectType::other, true},
    ObjectTerm{"BridgeFurniture", ObjectType::other, true},
    ObjectTerm{"Tunnel", ObjectType::tunnel},
    ObjectTerm{"TunnelPart", ObjectType::tunnel},
    ObjectTerm{"TunnelInstallation", ObjectType::tunnel},
    ObjectTerm{"TunnelConstructiveElement", ObjectType::tunnel},
    ObjectTerm{"TunnelHollowSpace", ObjectType::other, true},
    ObjectTerm{"TunnelFurniture", ObjectType::other, true},
    ObjectTerm{"Road", ObjectType::road},
    ObjectTerm{"Railway", ObjectType::railway},
    ObjectTerm{"TransportSquare", ObjectType::square},
    ObjectTerm{"Waterway", ObjectType::water},
    ObjectTerm{"WaterBody", ObjectType::water},
    ObjectTerm{"LandUse", ObjectType::land_use},
    ObjectTerm{"PlantCover", ObjectType::plant_cover},
    ObjectTerm{"SolitaryVegetationObject", ObjectType::solitary_vegetation},
    ObjectTerm{"TINRelief", ObjectType::terrain},
    ObjectTerm{"CityFurniture", ObjectType::furniture},
    ObjectTerm{"GenericCityObject", ObjectType::generic},
    ObjectTerm{"OtherConstruction", ObjectType::other},
    ObjectTerm{"CityObjectGroup", ObjectType::other},
};

}  // namespace

std::optional<ObjectTerm> object_term(std::string_view name) {
    const auto* found = std::find_if(kTypes.begin(), kTypes.end(), [&](const ObjectTerm& t) { return t.name == name; });
    return found == kTypes.end() ? std::nullopt : std::optional(*found);
}

SurfaceType surface_type_from(std::string_view name) {
    struct Entry {
        std::string_view name;
        SurfaceType type;
    };
    static constexpr std::array kTypes{
        Entry{"RoofSurface", SurfaceType::roof},
        Entry{"WallSurface", SurfaceType::wall},
        Entry{"GroundSurface", SurfaceType::ground},
        Entry{"ClosureSurface", SurfaceType::closure},
        Entry{"OuterCeilingSurface", SurfaceType::ceiling},
        Entry{"OuterFloorSurface", SurfaceType::floor},
        Entry{"CeilingSurface", SurfaceType::ceiling},
        Entry{"FloorSurface", SurfaceType::floor},
        Entry{"InteriorWallSurface", SurfaceType::wall},
        Entry{"Window", SurfaceType::window},
        Entry{"Door", SurfaceType::door},
        Entry{"WaterSurface", SurfaceType::water},
        Entry{"WaterGroundSurface", SurfaceType::other},
        Entry{"WaterClosureSurface", SurfaceType::closure},
        Entry{"TrafficArea", SurfaceType::road},
        Entry{"AuxiliaryTrafficArea", SurfaceType::road},
        Entry{"TransportationMarking", SurfaceType::road},
        Entry{"TransportationHole", SurfaceType::road},
    };
    for (const Entry& entry : kTypes) {
        if (entry.name == name) return entry.type;
    }
    return SurfaceType::unknown;
}

}  // namespace skybake::io
