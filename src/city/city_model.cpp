#include "city/city_model.h"

namespace skybake {

const char* name_of(ObjectType type) {
    switch (type) {
        case ObjectType::building:
            return "building";
        case ObjectType::building_part:
            return "building_part";
        case ObjectType::building_installation:
            return "building_installation";
        case ObjectType::bridge:
            return "bridge";
        case ObjectType::tunnel:
            return "tunnel";
        case ObjectType::road:
            return "road";
        case ObjectType::railway:
            return "railway";
        case ObjectType::square:
            return "square";
        case ObjectType::land_use:
            return "land_use";
        case ObjectType::plant_cover:
            return "plant_cover";
        case ObjectType::solitary_vegetation:
            return "solitary_vegetation";
        case ObjectType::water:
            return "water";
        case ObjectType::terrain:
            return "terrain";
        case ObjectType::furniture:
            return "furniture";
        case ObjectType::generic:
            return "generic";
        case ObjectType::other:
            return "other";
    }
    return "other";
}

const char* name_of(SurfaceType type) {
    switch (type) {
        case SurfaceType::unknown:
            return "unknown";
        case SurfaceType::ground:
            return "ground";
        case SurfaceType::wall:
            return "wall";
        case SurfaceType::roof:
            return "roof";
        case SurfaceType::closure:
            return "closure";
        case SurfaceType::floor:
            return "floor";
        case SurfaceType::ceiling:
            return "ceiling";
        case SurfaceType::window:
            return "window";
        case SurfaceType::door:
            return "door";
        case SurfaceType::terrain:
            return "terrain";
        case SurfaceType::road:
            return "road";
        case SurfaceType::water:
            return "water";
        case SurfaceType::vegetation:
            return "vegetation";
        case SurfaceType::other:
            return "other";
    }
    return "other";
}

Box3d extent_of(const CityModel& city) {
    Box3d box;
    for (const CityObject& object : city.objects) {
        const Geometry& geometry = object.geometry;
        for (const Surface& surface : geometry.surfaces) {
            const std::uint32_t end = geometry.ring_first[surface.ring_end];
            for (std::uint32_t i = geometry.ring_first[surface.ring_begin]; i < end; ++i) {
                box.extend(geometry.vertices[geometry.corners[i]]);
            }
        }
    }
    return box;
}

bool is_building(ObjectType type) {
    return type == ObjectType::building || type == ObjectType::building_part ||
           type == ObjectType::building_installation;
}

bool is_ground(ObjectType type) {
    switch (type) {
        case ObjectType::terrain:
        case ObjectType::road:
        case ObjectType::railway:
        case ObjectType::square:
        case ObjectType::land_use:
        case ObjectType::plant_cover:
        case ObjectType::water:
            return true;
        default:
            return false;
    }
}

}  // namespace skybake
