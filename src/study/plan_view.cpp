#include "study/plan_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace skybake {

std::optional<std::size_t> PlanView::pixel_of(const Vec2d& p) const {
    const Vec2d at = (p - lo) / pixel_m;
    const double row = height - at.y;
    if (!(at.x >= 0.0 && at.x < width && row >= 0.0 && row < height)) return std::nullopt;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(at.x);
}

PlanView plan_view(const Scene& scene, const RayScene& rays, const Vec2d& lo, const Vec2d& hi, int pixels) {
    PlanView view;
    view.lo = lo;
    const Vec2d size = hi - lo;
    view.pixel_m = std::max(size.x, size.y) / pixels;
    view.width = std::max(1, static_cast<int>(std::ceil(size.x / view.pixel_m - 1e-9)));
    view.height = std::max(1, static_cast<int>(std::ceil(size.y / view.pixel_m - 1e-9)));
    view.object.assign(static_cast<std::size_t>(view.width) * view.height, PlanView::kNothing);
    const float top = scene.bounds.hi.z + 1.0f;
    tbb::parallel_for(0, view.height, [&](int row) {
        for (int column = 0; column < view.width; ++column) {
            const Vec2d p = lo + view.pixel_m * Vec2d(column + 0.5, view.height - row - 0.5) - Vec2d(scene.origin);
            const auto hit = rays.first_hit(Vec3f(static_cast<float>(p.x), static_cast<float>(p.y), top), {0, 0, -1});
            if (!hit) continue;
            view.object[static_cast<std::size_t>(row) * view.width + column] =
                scene.faces[scene.triangle_face[hit->triangle].index()].object;
        }
    });
    return view;
}

}  // namespace skybake
