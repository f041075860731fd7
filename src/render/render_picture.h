// Still pictures of a baked city: rays to the surfaces, albedo and light looked up there.
#pragma once

#include <optional>
#include <vector>

#include "base/progress.h"
#include "render/camera.h"
#include "render/display.h"
#include "render/picture_scene.h"
#include "trace/ray_scene.h"

namespace skybake {

struct PictureSettings {
    Camera camera;
    Vec2i size{1920, 1080};  // pixels, each at least 1
    int samples = 16;        // rays a pixel, at least 1
    PictureKind kind = PictureKind::lit;
    /// Factor from cd m⁻² to the tone mapper's input; none keeps the scene's own linear values.
    std::optional<float> exposure;
};

struct Picture {
    Vec2i size{0};
    /// Row 0 on top. With an exposure: linear [0, 1], to be encoded as it is. Without one: luminance (cd m⁻² per
    /// channel), albedo for PictureKind::textures. A measure is in its own unit either way: the mean over the samples
    /// that met a surface, 0 where none did.
    std::vector<Rgb> pixels;
    std::vector<float> coverage;  // the share of samples that met a surface
};

/// Takes the picture. `light` holds what `settings.kind` shows: illuminance, or the sky view factor. Samples of a pixel
/// stand on Hammersley's points, the same in every pixel, and weigh the same (box filter); they are tone mapped before
/// they are averaged, so that an edge against the sun stays smooth. The same bits whatever the number of threads.
/// Throws Interrupted when the user stops.
Picture render_picture(const PictureScene& scene, const RayScene& rays, const SurfaceLight& light,
                       const Backdrop& backdrop, const PictureSettings& settings, Progress& progress);

/// Three bytes a pixel (sRGB) of a picture whose values are linear [0, 1]; dithered where light makes smooth shades,
/// that is for lit and light.
std::vector<std::uint8_t> screen_bytes(const Picture& picture, PictureKind kind);

}  // namespace skybake
