#include "api/load_albedo.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <string>

#include "base/error.h"
#include "io/image/image.h"

namespace skybake {

namespace {

constexpr int kMaxSide = 1024;

AlbedoImage albedo_image(const io::Image8& picture) {
    // The pixels of a block are averaged as light, not as codes.
    const int block = (std::max(picture.width, picture.height) + kMaxSide - 1) / kMaxSide;
    AlbedoImage image{(picture.width + block - 1) / block, (picture.height + block - 1) / block, {}};
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    const bool is_grey = picture.channels == 1;
    const auto code = [&](int x, int y, int c) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x);
        return picture
            .pixels[pixel * static_cast<std::size_t>(picture.channels) + static_cast<std::size_t>(is_grey ? 0 : c)];
    };
    for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < image.width; ++column) {
            auto& out = image.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                     static_cast<std::size_t>(column)];
            const int x1 = std::min((column + 1) * block, picture.width),
                      y1 = std::min((row + 1) * block, picture.height);
            for (int c = 0; c < 3; ++c) {
                if (block == 1) {
                    out[static_cast<std::size_t>(c)] = code(column, row, c);
                    continue;
                }
                float sum = 0.0f;
                for (int y = row * block; y < y1; ++y) {
                    for (int x = column * block; x < x1; ++x)
                        sum += linear_from_srgb(static_cast<float>(code(x, y, c)) / 255.0f);
                }
                const float mean = sum / static_cast<float>((x1 - column * block) * (y1 - row * block));
                out[static_cast<std::size_t>(c)] =
                    static_cast<std::uint8_t>(std::lround(255.0f * srgb_from_linear(mean)));
            }
        }
    }
    return image;
}

}  // namespace

void load_albedo_images(Scene& scene, FindingLog& findings, Progress& progress) {
    scene.albedo_images.assign(scene.textures.size(), {});
    std::vector<std::size_t> used;
    for (const SceneMaterial& material : scene.materials) {
        if (material.texture) used.push_back(material.texture->index());
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<std::string> faults(used.size());
    progress.begin("textures", used.size());
    tbb::parallel_for(std::size_t{0}, used.size(), [&](std::size_t i) {
        if (progress.stop_requested()) throw Interrupted();
        try {
            scene.albedo_images[used[i]] = albedo_image(io::read_image(scene.textures[used[i]]));
        } catch (const InputError& error) {
            faults[i] = error.what();
        }
        progress.advance(1);
    });
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (faults[i].empty()) continue;
        findings.add({"SB408", Severity::warning, scene.textures[used[i]].uri,
                      fmt::format("{} Its surfaces reflect {} of the light.", faults[i], kAlbedoWithoutTexture),
                      "Save the image again as PNG or JPEG."});
    }
}

}  // namespace skybake
