#include "api/study_texels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/bake_city.h"
#include "atlas/chart_samples.h"
#include "base/error.h"
#include "io/manifest/read_bake.h"
#include "io/manifest/sha256.h"
#include "io/manifest/write_layers.h"
#include "io/study/study_layers.h"

namespace skybake {
namespace {

/// Edge of a block of texels whose rays go together.
constexpr int kBlock = 4;
static_assert(kBlock * kBlock == RayScene::kPacketSize);

struct CityAtlas {
    Scene scene;
    Atlas atlas;
};

/// Of the request's cities the one that the bake was made from.
std::vector<std::filesystem::path> baked_files(const StudyRequest& request, const io::StoredBake& bake) {
    const auto is_baked = [&](const std::filesystem::path& file) {
        const std::string hash = io::hash_file(file).sha256;
        return std::any_of(bake.inputs.begin(), bake.inputs.end(),
                           [&](const io::StoredInput& input) { return input.sha256 == hash; });
    };
    for (const auto& files : {city_files(request), request.city, request.before}) {
        if (!files.empty() && std::all_of(files.begin(), files.end(), is_baked)) return files;
    }
    std::vector<std::string> names;
    for (const io::StoredInput& input : bake.inputs) names.push_back(input.file);
    throw InputError(
        fmt::format("{}: was not baked from these files, but from {} (or from other versions of them, by their "
                    "SHA-256). Name the files of the bake, or bake the city again.",
                    bake.folder.string(), fmt::join(names, ", ")));
}

CityAtlas baked_atlas(const StudyRequest& request, const LoadedCity& loaded, const io::StoredBake& bake,
                      Progress& progress) {
    const std::vector<std::filesystem::path> files = baked_files(request, bake);
    FindingLog told_already;
    const SceneOptions options = scene_options({}, static_cast<float>(bake.texel_m));
    CityAtlas city;
    city.scene = files == city_files(request)
                     ? build_scene(loaded.city, options, told_already)
                     : build_scene(load_city(files, request.load, progress).city, options, told_already);
    city.atlas = build_atlas(city.scene, {static_cast<float>(bake.texel_m)});
    return city;
}

[[noreturn]] void fail_to_match(const io::StoredBake& bake) {
    throw InputError(
        fmt::format("{}: its texels are not those of this city. It was baked with other options (--lod, --ground, "
                    "--crs, …), which stand in its manifest under \"settings\", or by another version: pass the same "
                    "options, or bake the city again.",
                    bake.folder.string()));
}

struct PageTexels {
    ReceiverSet receivers;                // one a chart
    std::vector<std::uint32_t> texel;     // [sample] its place in the page
    std::vector<std::string_view> owner;  // [receiver] id of its object
};

/// The chart's texels as samples, block by block. Throws when the page does not hold them.
void add_chart(PageTexels& texels, std::uint64_t& covered, const CityAtlas& city, ChartId id, const LightmapPage& page,
               const io::StoredBake& bake) {
    const Chart& chart = city.atlas.charts[id.index()];
    const ChartSamples samples = sample_chart(city.scene, chart);
    Receiver receiver;
    receiver.sample_begin = static_cast<std::uint32_t>(texels.texel.size());
    for (int block_row = 0; block_row < chart.size.y; block_row += kBlock) {
        for (int block_column = 0; block_column < chart.size.x; block_column += kBlock) {
            for (int k = 0; k < kBlock * kBlock; ++k) {
                const int row = block_row + k / kBlock, column = block_column + k % kBlock;
                if (row >= chart.size.y || column >= chart.size.x) continue;
                const std::size_t i = samples.index(column, row);
                if (samples.cover[i] == ChartSamples::Cover::none) continue;
                const std::size_t texel =
                    static_cast<std::size_t>(chart.position.y + row) * static_cast<std::size_t>(page.width) +
                    static_cast<std::size_t>(chart.position.x + column);
                const bool is_of_chart =
                    page.state[texel] == TexelState::chart || page.state[texel] == TexelState::buried;
                if (!is_of_chart || page.chart[texel] != id) fail_to_match(bake);
                ++covered;
                if (page.state[texel] == TexelState::buried) continue;
                Sample sample;
                sample.position = Vec3d(samples.position[i]) + city.scene.origin;
                sample.normal = shading_normal(city.scene, chart, samples.triangle[i]);
                sample.receiver = static_cast<std::uint32_t>(texels.receivers.receivers.size());
                texels.receivers.samples.push_back(sample);
                texels.texel.push_back(static_cast<std::uint32_t>(texel));
            }
        }
    }
    const Face& face = city.scene.faces[city.scene.triangle_face[chart.triangles.front()].index()];
    receiver.sample_end = static_cast<std::uint32_t>(texels.texel.size());
    texels.owner.push_back(city.scene.objects[face.object].id);
    texels.receivers.receivers.push_back(std::move(receiver));
}

PageTexels page_texels(const CityAtlas& city, std::size_t p, const LightmapPage& page, const io::StoredBake& bake) {
    PageTexels texels;
    std::uint64_t covered = 0;
    for (std::size_t c = 0; c < city.atlas.charts.size(); ++c) {
        if (city.atlas.charts[c].page.index() == p)
            add_chart(texels, covered, city, ChartId(static_cast<std::uint32_t>(c)), page, bake);
    }
    const auto stored = std::count_if(page.state.begin(), page.state.end(), [](TexelState state) {
        return state == TexelState::chart || state == TexelState::buried;
    });
    if (covered != static_cast<std::uint64_t>(stored)) fail_to_match(bake);
    return texels;
}

void check_pages(const io::StoredBake& bake, const Atlas& atlas) {
    bool fits = bake.pages.size() == atlas.pages.size() && bake.charts == atlas.charts.size();
    for (std::size_t p = 0; fits && p < atlas.pages.size(); ++p)
        fits = bake.pages[p].width == atlas.pages[p].width && bake.pages[p].height == atlas.pages[p].height;
    if (!fits) fail_to_match(bake);
}

/// Puts the values of a page's samples where they belong. `is_told` says of which receivers.
std::vector<float> on_page(const PageTexels& texels, std::span<const float> values, std::size_t texel_count,
                           const std::vector<char>& is_told) {
    std::vector<float> page(texel_count, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t s = 0; s < values.size(); ++s) {
        if (is_told[texels.receivers.samples[s].receiver]) page[texels.texel[s]] = values[s];
    }
    return page;
}

/// Whether anything of the object stands there; Scene::objects are sorted.
bool has_object(const Scene& scene, std::string_view id) {
    const auto at =
        std::lower_bound(scene.objects.begin(), scene.objects.end(), id,
                         [](const SceneObject& object, std::string_view wanted) { return object.id < wanted; });
    return at != scene.objects.end() && at->id == id;
}

}  // namespace

TexelStudy study_texels(const StudyRequest& request, const std::filesystem::path& bake_folder, Progress& progress) {
    const io::StoredBake bake = io::open_bake(bake_folder);
    const LoadedCity loaded = load_study_city(request, progress);
    const CityAtlas city = baked_atlas(request, loaded, bake, progress);
    check_pages(bake, city.atlas);
    PreparedStudy prepared = prepare_states(request, loaded, progress);
    Rule rule = request.rule;  // for its metrics only: texels have no areas to be judged by
    rule.metrics = rule.all_metrics();
    rule.criteria.clear();

    TexelStudy result;
    result.findings = prepared.findings;
    std::vector<io::BakeLayer> layers;
    std::vector<Metric> metrics;  // of the layers
    for (std::size_t p = 0; p < bake.pages.size(); ++p) {
        const LightmapPage page = io::read_base(bake, p);
        PageTexels texels = page_texels(city, p, page, bake);
        std::vector<char> is_there, is_comparable;
        for (const std::string_view owner : texels.owner) {
            is_there.push_back(has_object(prepared.after->scene, owner));
            is_comparable.push_back(is_there.back() && prepared.before && has_object(prepared.before->scene, owner));
        }
        Study study = run_study(rule, std::move(texels.receivers), prepared.days, prepared.city(), prepared.former(),
                                prepared.settings, progress);
        texels.receivers = std::move(study.receivers);
        result.texels += texels.texel.size();
        result.rays += study.rays;
        std::size_t next = 0;
        const auto add = [&](const std::vector<float>& values, const std::vector<char>& is_told, Metric metric,
                             io::BakeLayer layer) {
            if (p == 0) {
                layers.push_back(std::move(layer));
                metrics.push_back(metric);
            }
            layers[next++].values.push_back(on_page(texels, values, page.state.size(), is_told));
        };
        for (std::size_t c = 0; c < study.columns.size(); ++c) {
            const Column& column = study.columns[c];
            if (column.is_before) continue;
            add(column.values, column.metric == Metric::new_shadow_hours ? is_comparable : is_there, column.metric,
                io::study_layer(rule, study, column));
            const std::optional<std::size_t> former = former_column(study, c);
            if (!former) continue;
            std::vector<float> change = column.values;
            for (std::size_t s = 0; s < change.size(); ++s) change[s] -= study.columns[*former].values[s];
            add(change, is_comparable, column.metric, io::change_layer(rule, study, column));
        }
    }
    for (std::size_t l = 0; l < layers.size(); ++l) {
        io::settle_legend(layers[l], request.rule, metrics[l]);
        result.layers.push_back(layers[l].id);
    }
    io::write_layers(bake, layers, progress);
    return result;
}

}  // namespace skybake
