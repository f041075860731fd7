// `town`: the procedural old town as CityJSON, with its pictures beside it.
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "base/error.h"
#include "city/town/town.h"
#include "io/cityjson/write_city_json.h"
#include "io/image/image.h"
#include "io/lamps/write_town_lamps.h"
#include "program.h"

namespace skybake::cli {
namespace {

struct Options {
    std::string output;
    TownOptions town;
    std::string variant;
};

struct Counts {
    std::uint64_t buildings = 0;
    std::uint64_t surfaces = 0;
    std::uint64_t triangles = 0;
};

/// A polygon of c corners and h holes makes c + 2 h - 2 triangles, however it is cut.
Counts count(const CityModel& city) {
    Counts counts;
    for (const CityObject& object : city.objects) {
        if (object.type == ObjectType::building) ++counts.buildings;
        const Geometry& g = object.geometry;
        counts.surfaces += g.surfaces.size();
        for (const Surface& s : g.surfaces) {
            const std::uint64_t corners = g.ring_first[s.ring_end] - g.ring_first[s.ring_begin];
            counts.triangles += corners + 2 * (s.ring_end - s.ring_begin - 1) - 2;
        }
    }
    return counts;
}

/// town.city.json and town.jsonl both have town.lamps.json.
std::filesystem::path lamps_beside(const std::filesystem::path& city) {
    std::filesystem::path stem = city.stem();
    if (stem.extension() == ".city") stem = stem.stem();
    return city.parent_path() / (stem.string() + ".lamps.json");
}

int run(const CommonOptions& common, Options options) {
    const std::filesystem::path path = options.output;
    if (!options.variant.empty()) options.town.variant = TownVariant::with_tower;
    options.town.seed = common.seed;
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    const oneapi::tbb::global_control limit(
        oneapi::tbb::global_control::max_allowed_parallelism,
        static_cast<std::size_t>(common.threads > 0 ? common.threads : std::max(1, cores)));
    const auto begun = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    };
    const Town town = build_town(options.town);
    const double built = seconds();

    const std::filesystem::path pictures = path.parent_path() / "textures";
    std::error_code error;
    std::filesystem::create_directories(pictures, error);
    if (error)
        throw InputError(
            fmt::format("{}: cannot be made ({}). Choose another place with -o.", pictures.string(), error.message()));
    std::uint64_t picture_bytes = 0;
    for (const NamedImage& image : town.images) {
        io::write_png(pictures / image.name, {image.width, image.height, 3, image.pixels});
        picture_bytes += std::filesystem::file_size(pictures / image.name);
    }
    io::write_city_json(town.city, path);
    const std::filesystem::path lamps = lamps_beside(path);
    io::write_town_lamps(lamps, town.lamps);

    const Counts counts = count(town.city);
    const std::uint64_t bytes = std::filesystem::file_size(path);
    say(common, fmt::format("{}: {} buildings, {} surfaces, {} triangles, {:.1f} MB and {} pictures of {:.1f} MB, {} "
                            "lamps, in {:.1f} s",
                            path.string(), counts.buildings, counts.surfaces, counts.triangles,
                            static_cast<double>(bytes) * 1e-6, town.images.size(),
                            static_cast<double>(picture_bytes) * 1e-6, town.lamps.size(), seconds()));
    if (common.wants_json) {
        print_json({{"output", path.string()},
                    {"buildings", counts.buildings},
                    {"objects", town.city.objects.size()},
                    {"surfaces", counts.surfaces},
                    {"triangles", counts.triangles},
                    {"textures", town.images.size()},
                    {"lamps", lamps.string()},
                    {"lamp_count", town.lamps.size()},
                    {"bytes", bytes},
                    {"texture_bytes", picture_bytes},
                    {"crs", town.city.crs},
                    {"seed", common.seed},
                    {"variant", options.variant.empty() ? "as-built" : options.variant},
                    {"seconds", {{"build", built}, {"write", seconds() - built}, {"total", seconds()}}}});
    }
    return kDone;
}

}  // namespace

void add_town(CLI::App& app, Program& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* verb = add_verb(app, program, "town", "Builds the procedural old town as CityJSON 2.0 with textures.",
                              "  skybake town -o town.city.json\n"
                              "  skybake town -o big.city.jsonl --buildings 10000 --seed 7\n"
                              "  skybake town -o plan.city.json --variant with-tower",
                              [&program, options] { return run(program.common, *options); });
    verb->add_option(
            "-o,--output", options->output,
            "file to write; CityJSONSeq when it ends in .jsonl; pictures go to textures/ beside it, street lamps "
            "to NAME.lamps.json")
        ->required();
    verb->add_option("--buildings", options->town.buildings, "buildings, landmarks among them")
        ->capture_default_str()
        ->check(CLI::Range(kMinTownBuildings, kMaxTownBuildings));
    verb->add_option("--variant", options->variant,
                     "with-tower: the same town and a planned high-rise of 24 m × 24 m × 70 m")
        ->check(CLI::IsMember({"with-tower"}));
}

}  // namespace skybake::cli
