#include "render/lit_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/check.h"

namespace skybake {
namespace {

constexpr int kGutterTexels = 2;  // atlas: kGutter

/// Affine coordinates of a point about a triangle; the area is not 0.
struct Affine {
    Vec2f a, to_u, to_v;

    explicit Affine(const std::array<Vec2f, 3>& corners) : a(corners[0]) {
        const Vec2f e = corners[1] - a, f = corners[2] - a;
        const float area = e.x * f.y - e.y * f.x;
        to_u = Vec2f(f.y, -f.x) / area;
        to_v = Vec2f(-e.y, e.x) / area;
    }
    Vec3f weights(const Vec2f& point) const {
        const float u = glm::dot(point - a, to_u), v = glm::dot(point - a, to_v);
        return {1.0f - u - v, u, v};
    }
};

float area_of(const std::array<Vec2f, 3>& t) {
    return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
}

class PagePainter {
  public:
    PagePainter(const PictureScene& scene, const LightPage& light, const Vec2i& size, const LitPageSettings& settings)
        : scene_(scene), light_(light), settings_(settings), size_(settings.detail * size) {
        pixels_.resize(3 * count());
        is_painted_.resize(count());
    }

    void paint(const PictureSurface& surface) {
        const float detail = static_cast<float>(settings_.detail);
        std::array<Vec2f, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) corners[k] = detail * surface.texel[k];
        if (!(std::abs(area_of(corners)) > 1e-12f)) return;
        const Affine affine(corners);
        const Vec2f low = glm::min(corners[0], glm::min(corners[1], corners[2]));
        const Vec2f high = glm::max(corners[0], glm::max(corners[1], corners[2]));
        const Vec2f footprint = footprint_of(surface, affine);
        const int left = std::max(0, static_cast<int>(std::floor(low.x)));
        const int right = std::min(size_.x - 1, static_cast<int>(std::floor(high.x)));
        const int top = std::max(0, static_cast<int>(std::floor(low.y)));
        const int bottom = std::min(size_.y - 1, static_cast<int>(std::floor(high.y)));
        for (int y = top; y <= bottom; ++y) {
            for (int x = left; x <= right; ++x) {
                const Vec2f point(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                const Vec3f weights = affine.weights(point);
                constexpr float kSlack = -1e-4f;  // no pixel falls between two triangles
                if (weights.x < kSlack || weights.y < kSlack || weights.z < kSlack) continue;
                put(x, y, surface, weights, point / detail, footprint);
            }
        }
        // What is thinner than a pixel shows in one at least.
        const Vec2f middle = (corners[0] + corners[1] + corners[2]) / 3.0f;
        const int x = std::clamp(static_cast<int>(middle.x), 0, size_.x - 1);
        const int y = std::clamp(static_cast<int>(middle.y), 0, size_.y - 1);
        if (!is_painted_[at(x, y)]) put(x, y, surface, Vec3f(1.0f / 3.0f), middle / detail, footprint);
    }

    /// Repeats the edges of charts outwards, a pixel a round.
    void fill_gutters() {
        for (int round = 0; round < kGutterTexels * settings_.detail; ++round) {
            std::vector<std::pair<std::size_t, std::size_t>> copies;
            for (int y = 0; y < size_.y; ++y) {
                for (int x = 0; x < size_.x; ++x) {
                    if (is_painted_[at(x, y)]) continue;
                    if (const auto source = painted_neighbour(x, y)) copies.emplace_back(at(x, y), *source);
                }
            }
            for (const auto& [target, source] : copies) {
                std::copy_n(pixels_.begin() + static_cast<std::ptrdiff_t>(3 * source), 3,
                            pixels_.begin() + static_cast<std::ptrdiff_t>(3 * target));
                is_painted_[target] = 1;
            }
        }
    }

    std::vector<std::uint8_t> take() { return std::move(pixels_); }

  private:
    std::size_t count() const { return static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y); }
    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
    }

    std::optional<std::size_t> painted_neighbour(int x, int y) const {
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
            const int nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= size_.x || ny >= size_.y) continue;
            if (is_painted_[at(nx, ny)]) return at(nx, ny);
        }
        return {};
    }

    /// How far albedo coordinates move from a pixel to the next.
    static Vec2f footprint_of(const PictureSurface& surface, const Affine& affine) {
        const Vec2f e = surface.albedo_uv[1] - surface.albedo_uv[0], f = surface.albedo_uv[2] - surface.albedo_uv[0];
        const Vec2f along = affine.to_u.x * e + affine.to_v.x * f, down = affine.to_u.y * e + affine.to_v.y * f;
        return glm::max(glm::abs(along), glm::abs(down));
    }

    void put(int x, int y, const PictureSurface& surface, const Vec3f& weights, const Vec2f& texel,
             const Vec2f& footprint) {
        Rgb albedo(1.0f);
        if (settings_.kind == PictureKind::lit) {
            const PictureMaterial& material = scene_.materials[surface.material];
            albedo = material.base_colour;
            if (material.texture) {
                const Vec2f uv = weights.x * surface.albedo_uv[0] + weights.y * surface.albedo_uv[1] +
                                 weights.z * surface.albedo_uv[2];
                albedo *= scene_.textures[*material.texture].at(uv, footprint, material.wrap);
            }
        }
        const Rgb luminance = albedo * light_.bilinear(texel) / static_cast<float>(kPi);
        const Rgb shown = agx_tone_mapped(settings_.exposure * luminance);
        for (int c = 0; c < 3; ++c)
            pixels_[3 * at(x, y) + static_cast<std::size_t>(c)] = dithered_srgb(shown[c], x, size_.y - 1 - y);
        is_painted_[at(x, y)] = 1;
    }

    const PictureScene& scene_;
    const LightPage& light_;
    const LitPageSettings& settings_;
    Vec2i size_;
    std::vector<std::uint8_t> pixels_;
    std::vector<std::uint8_t> is_painted_;
};

}  // namespace

std::vector<std::uint8_t> lit_page(const PictureScene& scene, const LightPage& light, std::uint32_t page,
                                   const Vec2i& size, const LitPageSettings& settings) {
    SKYBAKE_CHECK_LT(0, settings.detail);
    PagePainter painter(scene, light, size, settings);
    for (const PictureSurface& surface : scene.surfaces) {
        if (surface.page == page) painter.paint(surface);
    }
    painter.fill_gutters();
    return painter.take();
}

}  // namespace skybake
