#include "render/render_picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "base/low_discrepancy.h"

namespace skybake {
namespace {

constexpr int kTile = 32;

/// Beyond this the backdrop is white on any screen: an average over samples stays finite in `float`. cd m⁻².
constexpr float kBrightest = 6.0e7f;

bool has_light(PictureKind kind) {
    return kind == PictureKind::lit || kind == PictureKind::light;
}

/// Barycentric coordinates (of corners 1 and 2) at which a ray meets the plane of a triangle; its infinite plane, so
/// they may lie outside. None when the ray runs along the plane or away from it.
std::optional<Vec2f> on_plane_of(const std::array<Vec3f, 3>& triangle, const CameraRay& ray) {
    const Vec3f e1 = triangle[1] - triangle[0];
    const Vec3f e2 = triangle[2] - triangle[0];
    const Vec3f normal = glm::cross(e1, e2);
    const float distance = glm::dot(normal, triangle[0] - ray.origin) / glm::dot(normal, ray.direction);
    if (!(distance > 0.0f) || !std::isfinite(distance)) return {};
    const Vec3f p = ray.origin + distance * ray.direction - triangle[0];
    const float square = glm::dot(normal, normal);
    return Vec2f(glm::dot(glm::cross(p, e2), normal), glm::dot(glm::cross(e1, p), normal)) / square;
}

Vec2f interpolated(const std::array<Vec2f, 3>& corners, float u, float v) {
    return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
}

/// Takes the samples of one picture.
class Photographer {
  public:
    Photographer(const PictureScene& scene, const RayScene& rays, const SurfaceLight& light, const Backdrop& backdrop,
                 const PictureSettings& settings)
        : scene_(scene), rays_(rays), light_(light), backdrop_(backdrop), settings_(settings) {
        for (int i = 0; i < settings.samples; ++i) {
            places_.emplace_back((static_cast<float>(i) + 0.5f) / static_cast<float>(settings.samples),
                                 static_cast<float>(radical_inverse(2, static_cast<std::uint32_t>(i))) +
                                     0.5f / static_cast<float>(settings.samples));
        }
        sample_width_ = 1.0f / std::sqrt(static_cast<float>(settings.samples));
    }

    void take(int column, int row, Rgb& pixel, float& coverage) const {
        Rgb sum(0.0f);
        int hits = 0;
        for (const Vec2f& within : places_) {
            const Vec2f place(static_cast<float>(column) + within.x, static_cast<float>(row) + within.y);
            const CameraRay ray = camera_ray(settings_.camera, place, settings_.size);
            const std::optional<Hit> hit = rays_.first_hit(ray.origin, ray.direction);
            if (hit) ++hits;
            if (!hit && is_measure(settings_.kind)) continue;
            const Rgb value = hit ? surface(*hit, ray, place) : behind(ray);
            sum +=
                has_light(settings_.kind) && settings_.exposure ? agx_tone_mapped(*settings_.exposure * value) : value;
        }
        const int weight = is_measure(settings_.kind) ? hits : settings_.samples;
        pixel = weight > 0 ? sum / static_cast<float>(weight) : Rgb(0.0f);
        coverage = static_cast<float>(hits) / static_cast<float>(settings_.samples);
    }

  private:
    Rgb behind(const CameraRay& ray) const {
        if (settings_.kind == PictureKind::textures) return paper_colour(ray.direction);
        const Rgb radiance = backdrop_.radiance(ray.origin, ray.direction);
        return {std::min(radiance.x, kBrightest), std::min(radiance.y, kBrightest), std::min(radiance.z, kBrightest)};
    }

    Rgb surface(const Hit& hit, const CameraRay& ray, const Vec2f& place) const {
        const PictureSurface& surface = scene_.surfaces[hit.triangle];
        // How the texture coordinates change over the width of a sample, from the rays beside it in the plane of the
        // triangle (ray differentials: H. Igehy, "Tracing ray differentials", SIGGRAPH 1999).
        const std::array<Vec3f, 3>& triangle = scene_.triangles[hit.triangle];
        Vec2f albedo_width(0.0f);
        float texel_width = 0.0f;
        for (const Vec2f& step : {Vec2f(sample_width_, 0.0f), Vec2f(0.0f, sample_width_)}) {
            const std::optional<Vec2f> beside =
                on_plane_of(triangle, camera_ray(settings_.camera, place + step, settings_.size));
            if (!beside) continue;
            const Vec2f change = *beside - Vec2f(hit.u, hit.v);
            const auto across = [&](const std::array<Vec2f, 3>& corners) {
                return change.x * (corners[1] - corners[0]) + change.y * (corners[2] - corners[0]);
            };
            albedo_width = glm::max(albedo_width, glm::abs(across(surface.albedo_uv)));
            texel_width = std::max(texel_width, glm::length(across(surface.texel)));
        }
        const auto light = [&] {
            return light_[surface.page].at(interpolated(surface.texel, hit.u, hit.v), texel_width);
        };
        if (is_measure(settings_.kind)) return light();
        Rgb albedo(1.0f);
        if (settings_.kind != PictureKind::light) {
            const PictureMaterial& material = scene_.materials[surface.material];
            albedo = material.base_colour;
            if (material.texture) {
                albedo *= scene_.textures[*material.texture].at(interpolated(surface.albedo_uv, hit.u, hit.v),
                                                                albedo_width, material.wrap);
            }
        }
        if (settings_.kind == PictureKind::textures) return albedo;
        const Rgb luminance = albedo * light() / static_cast<float>(kPi);
        if (settings_.kind == PictureKind::light) return luminance;  // for comparing walls, near and far
        return backdrop_.through_air(luminance, ray.origin, ray.direction, hit.distance);
    }

    const PictureScene& scene_;
    const RayScene& rays_;
    const SurfaceLight& light_;
    const Backdrop& backdrop_;
    const PictureSettings& settings_;
    std::vector<Vec2f> places_;  // of the samples in a pixel
    float sample_width_ = 1.0f;  // pixels
};

}  // namespace

Picture render_picture(const PictureScene& scene, const RayScene& rays, const SurfaceLight& light,
                       const Backdrop& backdrop, const PictureSettings& settings, Progress& progress) {
    SKYBAKE_CHECK_EQ(scene.surfaces.size(), scene.triangles.size());
    SKYBAKE_CHECK_LT(0, settings.size.x);
    SKYBAKE_CHECK_LT(0, settings.size.y);
    SKYBAKE_CHECK_LT(0, settings.samples);
    const std::size_t count = static_cast<std::size_t>(settings.size.x) * static_cast<std::size_t>(settings.size.y);
    Picture picture{settings.size, std::vector<Rgb>(count), std::vector<float>(count)};
    const Photographer photographer(scene, rays, light, backdrop, settings);
    const Vec2i tiles = (settings.size + kTile - 1) / kTile;
    progress.begin("render", count);
    tbb::parallel_for(0, tiles.x * tiles.y, [&](int tile) {
        if (progress.stop_requested()) return;
        const Vec2i first(tile % tiles.x * kTile, tile / tiles.x * kTile);
        const Vec2i last = glm::min(first + kTile, settings.size);
        for (int row = first.y; row < last.y; ++row) {
            for (int column = first.x; column < last.x; ++column) {
                const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(settings.size.x) +
                                       static_cast<std::size_t>(column);
                photographer.take(column, row, picture.pixels[at], picture.coverage[at]);
            }
        }
        progress.advance(static_cast<std::uint64_t>((last.x - first.x) * (last.y - first.y)));
    });
    if (progress.stop_requested()) throw Interrupted();
    return picture;
}

std::vector<std::uint8_t> screen_bytes(const Picture& picture, PictureKind kind) {
    std::vector<std::uint8_t> bytes(3 * picture.pixels.size());
    tbb::parallel_for(0, picture.size.y, [&](int row) {
        for (int column = 0; column < picture.size.x; ++column) {
            const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.size.x) +
                                   static_cast<std::size_t>(column);
            for (std::size_t c = 0; c < 3; ++c) {
                const float linear = picture.pixels[at][static_cast<int>(c)];
                bytes[3 * at + c] = has_light(kind)
                                        ? dithered_srgb(linear, column, picture.size.y - 1 - row)
                                        : static_cast<std::uint8_t>(std::lround(255.0f * srgb_from_linear(linear)));
            }
        }
    });
    return bytes;
}

}  // namespace skybake
