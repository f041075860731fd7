// skybake render: a still picture from a bake, on the CPU.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "bake_choice.h"
#include "base/error.h"
#include "base/nearest_word.h"
#include "base/threads.h"
#include "io/exr/exr.h"
#include "io/image/image.h"
#include "io/manifest/read_picture.h"
#include "program.h"
#include "render/annotate.h"
#include "render/render_picture.h"
#include "sky/utc_time.h"
#include "view_link.h"

namespace skybake::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kLargestSide = 8192;
constexpr double kWalkthroughFovDeg = 60.0;  // viewer/src/three/viewer.ts

struct RenderOptions {
    std::string folder;
    std::string output;
    std::string camera;
    std::string view;
    std::string projection = "perspective";
    std::string size;
    std::string at;
    std::string picture;
    std::string parts;
    std::optional<float> exposure;
    double fov_deg = kWalkthroughFovDeg;
    std::optional<double> width_m;
    std::vector<double> range;
    bool is_logarithmic = false;
    bool is_plain = false;
    bool is_airless = false;
    int samples = 16;
};

constexpr std::array<std::pair<const char*, PictureKind>, 5> kKinds = {{{"lit", PictureKind::lit},
                                                                        {"textures", PictureKind::textures},
                                                                        {"light", PictureKind::light},
                                                                        {"illuminance", PictureKind::illuminance},
                                                                        {"sky-view", PictureKind::sky_view}}};
const std::vector<std::string> kProjections = {"perspective", "orthographic", "plan", "panorama"};

PictureKind kind_of(const std::string& name) {
    std::vector<std::string> names;
    for (const auto& [known, kind] : kKinds) {
        if (name == known) return kind;
        names.emplace_back(known);
    }
    unknown_word("--picture", name, names);
}

/// "1920x1080"; the default is what suits the projection.
Vec2i size_of(const RenderOptions& options) {
    if (options.size.empty()) return options.projection == "panorama" ? Vec2i(4096, 2048) : Vec2i(1920, 1080);
    Vec2i size(0);
    const char* end = options.size.data() + options.size.size();
    auto parsed = std::from_chars(options.size.data(), end, size.x);
    const bool has_both = parsed.ec == std::errc{} && parsed.ptr != end && *parsed.ptr == 'x';
    if (has_both) parsed = std::from_chars(parsed.ptr + 1, end, size.y);
    if (!has_both || parsed.ec != std::errc{} || parsed.ptr != end || std::min(size.x, size.y) < 1 ||
        std::max(size.x, size.y) > kLargestSide) {
        throw InputError(fmt::format("--size '{}': is WIDTHxHEIGHT in pixels, each from 1 to {}, as 1920x1080.",
                                     options.size, kLargestSide));
    }
    return size;
}

/// Where to look from: the link, the named view, the bake's first view, or the whole city from the south-west.
io::BakeView view_of(const RenderOptions& options, const io::StoredBake& bake, const std::optional<ViewLink>& link,
                     const Box3f& bounds) {
    if (link) return {"link", link->position, link->target};
    if (!options.view.empty()) {
        std::vector<std::string> names;
        for (const io::BakeView& view : bake.views) {
            if (view.name == options.view) return view;
            names.push_back(view.name);
        }
        if (names.empty()) throw InputError(fmt::format("--view '{}': the bake has no saved views.", options.view));
        unknown_word("--view", options.view, names);
    }
    if (!bake.views.empty()) return bake.views.front();
    const float distance = 1.2f * glm::length(bounds.size()) + 1.0f;
    return {"", bounds.center() + distance * glm::normalize(Vec3f(-1.0f, -1.4f, 1.0f)), bounds.center()};
}

struct Shot {
    Camera camera;
    std::optional<double> metres_per_pixel;  // where lengths can be measured
};

Shot shot_of(const RenderOptions& options, const io::StoredBake& bake, const std::optional<ViewLink>& link,
             const Box3f& bounds, const Vec2i& size) {
    const io::BakeView view = view_of(options, bake, link, bounds);
    const float fov = static_cast<float>(radians_from_degrees(options.fov_deg));
    if (options.projection == "perspective") return {perspective_camera(view.position, view.target, fov, size), {}};
    if (options.projection == "panorama") return {panorama_camera(view.position, view.target), {}};
    const float ratio = static_cast<float>(size.x) / static_cast<float>(size.y);
    Vec3f position = view.position;
    Vec3f target = view.target;
    // As much as the perspective shows at its target, or the whole city in a plan that names no place.
    float width = 2.0f * glm::length(target - position) * std::tan(0.5f * fov) * ratio;
    if (options.projection == "plan") {
        if (!link && options.view.empty()) {
            target = bounds.center();
            width = 1.06f * std::max(bounds.size().x, bounds.size().y * ratio);
        }
        position = target + Vec3f(0.0f, 0.0f, 1.0f);
    }
    if (options.width_m) width = static_cast<float>(*options.width_m);
    const float reach = glm::length(bounds.size()) + glm::length(target - bounds.center()) + width;
    return {orthographic_camera(position, target, width, reach, size), static_cast<double>(width) / size.x};
}

FalseColour scale_of(const RenderOptions& options, const std::optional<ViewLink>& link, const Picture& measure,
                     PictureKind kind) {
    if (options.range.empty() && !options.is_logarithmic && link && link->scale) return *link->scale;
    FalseColour scale = kind == PictureKind::sky_view ? FalseColour{} : range_of(measure);
    if (options.is_logarithmic) scale.low = scale.high / 100.0;
    if (!options.range.empty()) {
        scale.low = options.range[0];
        scale.high = options.range[1];
    }
    scale.is_logarithmic = options.is_logarithmic;
    return scale;
}

std::string legend_title(PictureKind kind, const io::PartFactors& parts) {
    if (kind == PictureKind::sky_view) return "Sky view factor";
    if (parts.empty()) return "Illuminance, lx";
    std::string names;
    for (const auto& [name, factor] : parts) {
        names += names.empty() ? "" : " + ";
        names += factor == 1.0f ? name : fmt::format("{:g} {}", factor, name);
    }
    return fmt::format("Illuminance, {}, lx", names);
}

class Stopwatch {
  public:
    /// Seconds since the last call.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void check_options(const RenderOptions& options) {
    const fs::path path = options.output;
    if (path.extension() != ".png" && path.extension() != ".exr")
        throw InputError(fmt::format("-o {}: the picture is a .png or an .exr.", options.output));
    if (path.has_parent_path() && !fs::is_directory(path.parent_path()))
        throw InputError(fmt::format("-o {}: there is no such folder. Make it first.", options.output));
    if (std::find(kProjections.begin(), kProjections.end(), options.projection) == kProjections.end())
        unknown_word("--projection", options.projection, kProjections);
    if (options.range.size() == 2 &&
        !(options.range[0] < options.range[1] && (options.range[0] > 0.0 || !options.is_logarithmic)))
        throw InputError("--range: goes from a lower to a higher value; with --log both are above 0.");
}

/// Options that would be passed over are refused: the user meant something by them.
void check_use(const RenderOptions& options, PictureKind kind) {
    const bool is_exr = fs::path(options.output).extension() == ".exr";
    const bool is_parallel = options.projection == "orthographic" || options.projection == "plan";
    const bool has_scale = !options.range.empty() || options.is_logarithmic;
    const auto refuse = [](bool is_wrong, const char* what) {
        if (is_wrong) throw InputError(fmt::format("{} Leave it out.", what));
    };
    refuse(options.exposure && is_exr, "--exposure: an .exr keeps the scene's own luminance.");
    refuse(options.exposure && (is_measure(kind) || kind == PictureKind::textures),
           "--exposure: this picture shows no luminance.");
    refuse(has_scale && (is_exr || !is_measure(kind)), "--range, --log: only a .png of a measure has false colours.");
    refuse(!options.parts.empty() && (kind == PictureKind::textures || kind == PictureKind::sky_view),
           "--parts: this picture shows no light.");
    refuse(options.width_m && !is_parallel, "--width: of orthographic pictures and plans.");
}

int run_render(const RenderOptions& options, const CommonOptions& common) {
    check_options(options);
    const Vec2i size = size_of(options);
    const std::optional<ViewLink> link =
        options.camera.empty() ? std::nullopt : std::optional(parse_view_link(options.camera));
    const ThreadLimit threads(common.threads);
    ConsoleProgress progress(common);
    Stopwatch watch;
    const io::StoredBake bake = io::open_bake(options.folder);
    const std::size_t instant = instant_of(bake, options.at, link);
    if (options.at.empty() && link && link->is_between)
        say(common, fmt::format("--camera: lies between two instants of the bake; shown is the nearer, {}.",
                                bake.instants[instant].label));
    const PictureKind kind = !options.picture.empty() ? kind_of(options.picture)
                             : link && link->kind     ? *link->kind
                                                      : PictureKind::lit;
    if (options.picture.empty() && link && !link->layer.empty())
        throw InputError(
            fmt::format("--camera: the link shows the study's layer '{}', which stills do not draw. Name another "
                        "picture with --picture.",
                        link->layer));
    check_use(options, kind);
    const std::vector<std::string> known = io::light_parts(bake, instant);
    const io::PartFactors parts =
        options.parts.empty() && link ? parts_of(*link, known) : parts_of(options.parts, known);
    const PictureScene scene = io::read_city(bake);
    if (scene.triangles.empty())
        throw InputError(fmt::format("{}: the city has no surfaces. Bake again.", options.folder));
    const Shot shot = shot_of(options, bake, link, scene.bounds, size);
    SurfaceLight light;
    if (kind == PictureKind::sky_view)
        light = io::read_sky_view(bake);
    else if (kind != PictureKind::textures)
        light = io::read_illuminance(bake, instant, parts);
    // Parallel rays come from nowhere: between them and the city there is no stated length of air.
    const bool is_airless = options.is_airless || shot.metres_per_pixel || (link && !link->has_air.value_or(true));
    const Backdrop backdrop = io::read_backdrop(bake, instant, is_airless ? io::AirUse::left_out : io::AirUse::seen);
    const double read_s = watch.lap();
    const RayScene rays(scene.triangles);
    const double build_s = watch.lap();

    const bool is_png = fs::path(options.output).extension() == ".png";
    PictureSettings settings{shot.camera, size, options.samples, kind, {}};
    if (is_png) {
        const float ev = options.exposure.value_or(link && link->ev ? *link->ev : 0.0f);
        settings.exposure = exposure_factor(bake.instants[instant].exposure_hint, ev, kind);
    }
    Picture picture = render_picture(scene, rays, light, backdrop, settings, progress);
    const double render_s = watch.lap();

    nlohmann::json json_range = nullptr;
    if (is_png) {
        Annotation annotation;
        if (is_measure(kind)) {
            const FalseColour scale = scale_of(options, link, picture, kind);
            picture = in_false_colours(picture, scale);
            annotation.legend = Legend{scale, legend_title(kind, parts)};
            json_range = {scale.low, scale.high};
        }
        if (shot.metres_per_pixel) {
            annotation.metres_per_pixel = shot.metres_per_pixel;
            const double north = -bake.convergence_rad;  // grid azimuth of true north
            const Vec3f toward(std::sin(north), std::cos(north), 0.0);
            const Vec2f shown(glm::dot(toward, shot.camera.right), glm::dot(toward, shot.camera.up));
            if (glm::length(shown) > 0.1f) annotation.north = shown;  // else it points into the picture
        }
        io::Image8 image{size.x, size.y, 3, screen_bytes(picture, kind)};
        if (!options.is_plain) draw_annotation(image.pixels, size, annotation);
        io::write_png(options.output, image);
    } else {
        const char* unit = kind == PictureKind::illuminance ? "lx per channel, linear Rec. 709"
                           : kind == PictureKind::sky_view || kind == PictureKind::textures
                               ? "1"
                               : "cd/m2 per channel, linear Rec. 709";
        io::write_exr_rgb(options.output, {size.x, size.y, std::move(picture.pixels)},
                          {{"skybake.instant", bake.instants[instant].label}, {"skybake.unit", unit}});
    }
    const double write_s = watch.lap();
    const double megapixels = 1e-6 * size.x * size.y;
    say(common,
        fmt::format("wrote {}: {} x {}, {}, {:.1f} s ({:.2f} s a megapixel)", options.output, size.x, size.y,
                    bake.instants[instant].label, read_s + build_s + render_s + write_s, render_s / megapixels));
    if (common.wants_json) {
        print_json({{"picture", options.output},
                    {"width", size.x},
                    {"height", size.y},
                    {"samples", options.samples},
                    {"triangles", scene.triangles.size()},
                    {"instant", bake.instants[instant].label},
                    {"parts", io::light_parts(bake, instant)},
                    {"range", json_range},
                    {"metres_per_pixel", shot.metres_per_pixel ? nlohmann::json(*shot.metres_per_pixel) : nullptr},
                    {"seconds", {{"read", read_s}, {"build", build_s}, {"render", render_s}, {"write", write_s}}},
                    {"seconds_per_megapixel", render_s / megapixels}});
    }
    return kDone;
}

}  // namespace

void add_render(CLI::App& app, Program& program) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* verb =
        add_verb(app, program, "render", "A still picture from a bake, on the CPU, as the walkthrough shows it.",
                 "  skybake render lit -o street.png --camera 'http://127.0.0.1:8080/#v=1&p=3,-40,2&t=0,0,5'\n"
                 "  skybake render lit -o plan.png --projection plan --picture illuminance --log\n"
                 "  skybake render lit -o sphere.exr --projection panorama --at 2026-06-21T12",
                 [options, &program] { return run_render(*options, program.common); });
    verb->add_option("DIR", options->folder, "folder of a bake (with manifest.json)")->required();
    verb->add_option("-o,--output", options->output,
                     "the picture: .png (as on the screen) or .exr (cd/m2; lx of a measure)")
        ->type_name("FILE")
        ->required();
    verb->add_option("--camera", options->camera, "the walkthrough's link: place, instant, picture and exposure")
        ->type_name("LINK");
    verb->add_option("--view", options->view, "a saved view of the bake; default: its first")->excludes("--camera");
    verb->add_option("--projection", options->projection, fmt::format("{}", fmt::join(kProjections, ", ")))
        ->capture_default_str();
    verb->add_option("--size", options->size, "WIDTHxHEIGHT in pixels; default 1920x1080, panorama 4096x2048");
    verb->add_option("--fov", options->fov_deg, "vertical angle of the perspective, degrees")
        ->capture_default_str()
        ->check(CLI::Range(1.0, 170.0));
    verb->add_option("--width", options->width_m, "metres across, orthographic and plan; default: as the perspective")
        ->check(CLI::Range(0.1, 1e6));
    verb->add_option("--at", options->at, "which instant: its number from 0, its label, or the label's beginning");
    verb->add_option("--picture", options->picture,
                     "lit, textures, light (on white); illuminance, sky-view (false colours)")
        ->type_name("NAME");
    verb->add_option("--parts", options->parts, "only these parts of the light, with factors: sun,sky=0.5")
        ->type_name("LIST");
    verb->add_option("--exposure", options->exposure, "stops above the automatic exposure; default 0, or the link's")
        ->check(CLI::Range(-16.0, 16.0));
    verb->add_option("--range", options->range, "LOW,HIGH of the false colours; default from the picture")
        ->delimiter(',')
        ->expected(2);
    verb->add_flag("--log", options->is_logarithmic, "false colours by the logarithm");
    verb->add_flag("--no-air", options->is_airless, "no haze over distance (orthographic and plan never have it)");
    verb->add_flag("--plain", options->is_plain, "no legend, north arrow and scale bar");
    verb->add_option("--samples", options->samples, "rays a pixel")->capture_default_str()->check(CLI::Range(1, 1024));
}

}  // namespace skybake::cli
