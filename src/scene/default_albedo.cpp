#include "scene/scene.h"

namespace skybake {

// Broadband visible albedos of weathered urban surfaces, rounded. Sources: T. R. Oke, "Boundary Layer Climates", 1987,
// table 1.1 and 8.2 (brick 0.20–0.40, tiles 0.10–0.35, asphalt 0.05–0.20, concrete 0.10–0.35, white paint 0.50–0.90,
// grass 0.16–0.26, water 0.03–0.10 at high sun); mean colours of plaster, clay tile and grass are ours, scaled to those
// values.
Rgb default_albedo(SurfaceType type) {
    switch (type) {
        case SurfaceType::wall:
            return {0.52f, 0.48f, 0.41f};
        case SurfaceType::roof:
            return {0.34f, 0.20f, 0.15f};
        case SurfaceType::window:
            return {0.12f, 0.13f, 0.14f};
        case SurfaceType::door:
            return {0.25f, 0.20f, 0.15f};
        case SurfaceType::ceiling:
            return {0.60f, 0.58f, 0.54f};
        case SurfaceType::terrain:
            return {0.24f, 0.23f, 0.20f};
        case SurfaceType::road:
            return {0.15f, 0.15f, 0.15f};
        case SurfaceType::water:
            return {0.06f, 0.08f, 0.09f};
        case SurfaceType::vegetation:
            return {0.14f, 0.21f, 0.09f};
        case SurfaceType::ground:
        case SurfaceType::floor:
            return {0.25f, 0.25f, 0.24f};
        case SurfaceType::closure:
        case SurfaceType::other:
        case SurfaceType::unknown:
            return {0.40f, 0.39f, 0.37f};
    }
    return {0.40f, 0.39f, 0.37f};
}

}  // namespace skybake
