#include "city/town/paint.h"

#include <oneapi/tbb/parallel_for.h>

#include <functional>

#include "base/hash_rng.h"
#include "city/town/paint_facades.h"
#include "city/town/paint_grounds.h"
#include "city/town/styles.h"

namespace skybake::town {

std::vector<NamedImage> paint_pictures(std::uint64_t seed) {
    std::vector<std::function<NamedImage(std::uint64_t)>> painters;
    for (int i = 0; i < kFacadeColours; ++i) painters.emplace_back([i](std::uint64_t s) { return paint_facade(s, i); });
    for (int i = 0; i < kFacadeColours; ++i)
        painters.emplace_back([i](std::uint64_t s) { return paint_plaster(s, i); });
    for (int i = 0; i < kRoofTiles; ++i) painters.emplace_back([i](std::uint64_t s) { return paint_tiles(s, i); });
    painters.insert(painters.end(), {paint_cobbles, paint_slabs, paint_gravel, paint_grass, paint_water, paint_masonry,
                                     paint_church, paint_copper, paint_clock, paint_glass});
    std::vector<NamedImage> images(painters.size());
    oneapi::tbb::parallel_for(std::size_t{0}, painters.size(),
                              [&](std::size_t i) { images[i] = painters[i](hash_combine(seed, i)); });
    return images;
}

}  // namespace skybake::town
