#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "base/check.h"
#include "base/hash_rng.h"
#include "city/town/ground.h"
#include "city/town/houses.h"
#include "city/town/landmarks.h"
#include "city/town/layout.h"
#include "city/town/paint.h"
#include "city/town/street_lamps.h"
#include "city/town/town.h"

namespace skybake {
namespace {

using namespace town;

void append(std::vector<CityObject>& all, std::vector<CityObject>&& more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
}

std::vector<CityObject> build_cell(std::uint64_t seed, const Layout& layout, std::size_t index, const Relief& relief,
                                   std::size_t first_church) {
    const Cell& cell = layout.cells[index];
    std::vector<CityObject> objects = build_ground(layout, cell, relief);
    for (std::uint32_t i = 0; i < layout.houses_in[index]; ++i)
        objects.push_back(build_house(seed, cell, cell.lots[i], relief));
    if (cell.use == CellUse::square) objects.push_back(build_column(cell, relief));
    if (cell.use == CellUse::church) append(objects, build_church(seed, cell, relief, index == first_church));
    return objects;
}

}  // namespace

Town build_town(const TownOptions& options) {
    SKYBAKE_CHECK_LE(kMinTownBuildings, options.buildings);
    SKYBAKE_CHECK_LE(options.buildings, kMaxTownBuildings);
    const std::uint64_t seed = hash_combine(options.seed, hash_of("town"));
    const Relief relief(seed);
    const Layout layout = lay_out(seed, options.buildings - kHillBuildings - 1);
    const auto first_church = static_cast<std::size_t>(
        std::find_if(layout.cells.begin(), layout.cells.end(), [](const Cell& c) { return c.use == CellUse::church; }) -
        layout.cells.begin());

    std::vector<std::vector<CityObject>> by_cell(layout.cells.size());
    oneapi::tbb::parallel_for(std::size_t{0}, layout.cells.size(),
                              [&](std::size_t i) { by_cell[i] = build_cell(seed, layout, i, relief, first_church); });

    Town town;
    for (std::vector<CityObject>& objects : by_cell) append(town.city.objects, std::move(objects));
    for (int s = layout.first_segment; s < layout.last_segment; ++s) {
        append(town.city.objects, build_river(layout, s, relief));
        if (has_bridge(layout, s)) town.city.objects.push_back(build_bridge(layout, s, relief));
    }
    append(town.city.objects, build_hilltop(seed, relief));
    if (options.variant == TownVariant::with_tower) {
        const auto site = std::find_if(layout.cells.begin(), layout.cells.end(),
                                       [](const Cell& c) { return c.use == CellUse::tower_site; });
        SKYBAKE_CHECK(site != layout.cells.end());
        town.city.objects.push_back(build_planned_tower(*site, relief));
    }

    town.lamps = place_lamps(seed, layout, relief);
    town.images = paint_pictures(seed);
    for (const NamedImage& image : town.images) {
        Texture texture;
        texture.uri = "textures/" + image.name;
        texture.wrap = TextureWrap::repeat;
        town.city.textures.push_back(std::move(texture));
    }
    town.city.crs = "https://www.opengis.net/def/crs/EPSG/0/31256";
    town.city.lods = {"2.2"};
    town.city.stated_extent = extent_of(town.city);
    return town;
}

}  // namespace skybake
