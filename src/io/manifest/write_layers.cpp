#include "io/manifest/write_layers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "base/error.h"
#include "io/exr/exr.h"
#include "io/file/replace_file.h"
#include "io/image/image.h"
#include "io/manifest/names.h"

namespace skybake::io {
namespace {

using Json = nlohmann::ordered_json;

std::uint8_t grey_of(const BakeLayer& layer, float value) {
    if (std::isnan(value)) value = 0.0f;
    const double share = (static_cast<double>(value) - layer.minimum) / (layer.maximum - layer.minimum);
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

void write_page(const StoredBake& bake, const BakeLayer& layer, std::size_t p, const LightmapPage& page) {
    const std::vector<float>& values = layer.values[p];
    const std::size_t width = static_cast<std::size_t>(page.width);
    write_exr(bake.folder / names::layer(layer.id, p, "exr"), page.width, page.height,
              std::vector<ExrChannel>{{"value", ExrType::float32}},
              [&](int row, std::span<std::uint32_t> samples) {
                  for (std::size_t c = 0; c < width; ++c)
                      samples[c] = std::bit_cast<std::uint32_t>(values[static_cast<std::size_t>(row) * width + c]);
              },
              {{"unit", layer.unit}});
    std::vector<float> filled = values;
    fill_charts(page, filled);
    Image8 picture{page.width, page.height, 1, {}};
    for (const float value : filled) picture.pixels.push_back(grey_of(layer, value));
    write_png(bake.folder / names::layer(layer.id, p, "png"), picture);
}

Json layer_json(const BakeLayer& layer) {
    Json json = {{"id", layer.id},
                 {"title", {{"en", layer.title_en}, {"de", layer.title_de}}},
                 {"unit", layer.unit},
                 {"minimum", layer.minimum},
                 {"maximum", layer.maximum}};
    if (!layer.edges.empty()) json["edges"] = layer.edges;
    json["kind"] = layer.kind == LayerKind::diverging ? "diverging" : "sequential";
    json["pages"] = Json::array();
    for (std::size_t p = 0; p < layer.values.size(); ++p)
        json["pages"].push_back({{"png", names::layer(layer.id, p, "png")}, {"exr", names::layer(layer.id, p, "exr")}});
    return json;
}

/// The entry that holds `name` under `key`, or a new one at the end.
Json& entry_of(Json& list, const char* key, const std::string& name) {
    for (Json& entry : list) {
        if (entry.at(key) == name) return entry;
    }
    return list.emplace_back();
}

}  // namespace

void fill_charts(const LightmapPage& page, std::vector<float>& values) {
    std::vector<std::size_t> open;
    for (std::size_t t = 0; t < values.size(); ++t) {
        if (page.state[t] != TexelState::empty && std::isnan(values[t])) open.push_back(t);
    }
    const auto mean_of_neighbours = [&](std::size_t t) {
        const int column = static_cast<int>(t % static_cast<std::size_t>(page.width));
        const int row = static_cast<int>(t / static_cast<std::size_t>(page.width));
        float sum = 0.0f;
        int count = 0;
        for (int y = std::max(row - 1, 0); y <= std::min(row + 1, page.height - 1); ++y) {
            for (int x = std::max(column - 1, 0); x <= std::min(column + 1, page.width - 1); ++x) {
                const std::size_t n =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(page.width) + static_cast<std::size_t>(x);
                const bool is_own = page.state[n] != TexelState::empty && page.chart[n] == page.chart[t];
                if (!is_own || std::isnan(values[n])) continue;
                sum += values[n];
                ++count;
            }
        }
        return count > 0 ? sum / static_cast<float>(count) : std::nanf("");
    };
    while (!open.empty()) {
        // All of a ring from the rings before it.
        std::vector<std::pair<std::size_t, float>> ring;
        std::vector<std::size_t> left;
        for (const std::size_t t : open) {
            const float mean = mean_of_neighbours(t);
            if (std::isnan(mean)) {
                left.push_back(t);
            } else {
                ring.emplace_back(t, mean);
            }
        }
        if (ring.empty()) return;
        for (const auto& [t, mean] : ring) values[t] = mean;
        open = std::move(left);
    }
}

void write_layers(const StoredBake& bake, const std::vector<BakeLayer>& layers, Progress& progress) {
    const std::filesystem::path manifest_path = bake.folder / names::kManifest;
    const std::vector<std::uint8_t> bytes = read_file(manifest_path);
    Json manifest = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (!manifest.is_object()) throw InputError(manifest_path.string() + ": is no manifest of a bake. Bake again.");
    std::error_code error;
    std::filesystem::create_directories(bake.folder / names::kLayerFolder, error);
    if (error)
        throw InputError(
            fmt::format("{}: cannot be made: {}.", (bake.folder / names::kLayerFolder).string(), error.message()));
    progress.begin("write", layers.size() * bake.pages.size());
    for (std::size_t p = 0; p < bake.pages.size(); ++p) {
        const LightmapPage page = read_base(bake, p);
        tbb::parallel_for(std::size_t{0}, layers.size(), [&](std::size_t l) {
            SKYBAKE_CHECK_EQ(layers[l].values.at(p).size(), page.state.size());
            if (progress.stop_requested()) throw Interrupted();
            write_page(bake, layers[l], p, page);
            progress.advance(1);
        });
    }
    if (!manifest.contains("layers")) manifest["layers"] = Json::array();
    for (const BakeLayer& layer : layers) {
        entry_of(manifest["layers"], "id", layer.id) = layer_json(layer);
        for (std::size_t p = 0; p < bake.pages.size(); ++p) {
            for (const char* extension : {"png", "exr"}) {
                const std::string name = names::layer(layer.id, p, extension);
                entry_of(manifest.at("files"), "name", name) = {
                    {"name", name}, {"bytes", std::filesystem::file_size(bake.folder / name)}};
            }
        }
    }
    FileReplacement file(manifest_path);
    file.write(manifest.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    file.commit();
}

}  // namespace skybake::io
