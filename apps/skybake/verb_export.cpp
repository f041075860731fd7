// skybake export: the lit city for programs that know no lightmaps.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "bake_choice.h"
#include "base/error.h"
#include "base/threads.h"
#include "io/gltf/unlit_glb.h"
#include "io/image/image.h"
#include "io/manifest/names.h"
#include "io/manifest/read_picture.h"
#include "program.h"
#include "render/lit_page.h"

namespace skybake::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kLargestTexture = 8192;  // what most graphics cards take

struct ExportOptions {
    std::string folder;
    std::string output;
    std::string at;
    std::string picture = "lit";
    std::string parts;
    float exposure = 0.0f;
    int detail = 2;
};

int run_export(const ExportOptions& options, const CommonOptions& common) {
    if (fs::path(options.output).extension() != ".glb")
        throw InputError(fmt::format("-o {}: the file is a .glb.", options.output));
    if (options.picture != "lit" && options.picture != "light")
        unknown_word("--picture", options.picture, {"lit", "light"});
    const ThreadLimit threads(common.threads);
    ConsoleProgress progress(common);
    const io::StoredBake bake = io::open_bake(options.folder);
    const std::size_t instant = instant_of(bake, options.at, std::nullopt);
    const io::PartFactors parts = parts_of(options.parts, io::light_parts(bake, instant));
    for (const io::StoredPage& page : bake.pages) {
        const int side = options.detail * std::max(page.width, page.height);
        if (side > kLargestTexture)
            throw InputError(
                fmt::format("--detail {}: textures would be {} pixels wide, more than the {} that graphics "
                            "cards take. Lower it.",
                            options.detail, side, kLargestTexture));
    }
    const PictureScene scene = io::read_city(bake);
    const SurfaceLight light = io::read_illuminance(bake, instant, parts);
    LitPageSettings settings;
    settings.detail = options.detail;
    settings.kind = options.picture == "lit" ? PictureKind::lit : PictureKind::light;
    settings.exposure = exposure_factor(bake.instants[instant].exposure_hint, options.exposure, settings.kind);
    std::vector<std::vector<std::uint8_t>> pngs(bake.pages.size());
    progress.begin("paint pages", pngs.size());
    tbb::parallel_for(std::size_t{0}, pngs.size(), [&](std::size_t p) {
        if (progress.stop_requested()) return;
        const Vec2i size(bake.pages[p].width, bake.pages[p].height);
        io::Image8 picture{settings.detail * size.x, settings.detail * size.y, 3, {}};
        picture.pixels = lit_page(scene, light[p], static_cast<std::uint32_t>(p), size, settings);
        pngs[p] = io::encode_png(picture);
        progress.advance(1);
    });
    if (progress.stop_requested()) throw Interrupted();
    io::write_unlit_glb(bake.folder / io::names::kCity, options.output, pngs, "skybake " SKYBAKE_VERSION);
    const std::uintmax_t bytes = fs::file_size(options.output);
    say(common, fmt::format("{}: {}, {:.1f} MB.", options.output, bake.instants[instant].label,
                            static_cast<double>(bytes) * 1e-6));
    if (common.wants_json) {
        print_json({{"file", options.output},
                    {"instant", bake.instants[instant].label},
                    {"pages", pngs.size()},
                    {"triangles", scene.triangles.size()},
                    {"bytes", bytes}});
    }
    return kDone;
}

}  // namespace

void add_export(CLI::App& app, Program& program) {
    const auto options = std::make_shared<ExportOptions>();
    CLI::App* verb = add_verb(app, program, "export",
                              "The city with its light painted on, as an unlit GLB that every glTF viewer shows lit.",
                              "  skybake export lit -o town.glb --at 2026-06-21T18\n"
                              "  skybake export lit -o white.glb --picture light --detail 4",
                              [options, &program] { return run_export(*options, program.common); });
    verb->add_option("DIR", options->folder, "folder of a bake (with manifest.json)")->required();
    verb->add_option("-o,--output", options->output, "the .glb to write")->type_name("FILE")->required();
    verb->add_option("--at", options->at, "which instant: its number from 0, its label, or the label's beginning");
    verb->add_option("--picture", options->picture, "lit, or light (on white)")->capture_default_str();
    verb->add_option("--parts", options->parts, "only these parts of the light, with factors: sun,sky=0.5")
        ->type_name("LIST");
    verb->add_option("--exposure", options->exposure, "stops above the automatic exposure")
        ->capture_default_str()
        ->check(CLI::Range(-16.0, 16.0));
    verb->add_option("--detail", options->detail, "pixels along a texel's edge: more keep more of the textures")
        ->capture_default_str()
        ->check(CLI::Range(1, 16));
}

}  // namespace skybake::cli
