#include "study/receivers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "study/ground_cells.h"
#include "study/surface_cells.h"

namespace skybake {
namespace {

/// The underside of a building so low above the ground hides what nobody walks on.
constexpr float kCrawlM = 1.0f;

/// A wall so near to another is a party wall.
constexpr float kTouchingM = 0.1f;

/// One of eight directions at 45° about the normal reaches the sky.
bool sees_sky(const Vec3f& origin, const Vec3f& normal, const RayScene& rays) {
    const Vec3f aside = std::abs(normal.z) < 0.9f ? Vec3f(0, 0, 1) : Vec3f(1, 0, 0);
    const Vec3f u = glm::normalize(glm::cross(aside, normal)), v = glm::cross(normal, u);
    for (int k = 0; k < 8; ++k) {
        const float turn = static_cast<float>(kPi / 4.0) * static_cast<float>(k);
        const Vec3f direction = glm::normalize(normal + std::cos(turn) * u + std::sin(turn) * v);
        if (direction.z > 0.0f && !rays.is_occluded(origin, direction)) return true;
    }
    return false;
}

bool is_enclosed(const Sample& sample, const Scene& scene, const RayScene& rays) {
    const Vec3f origin = Vec3f(sample.position - scene.origin) + rays.surface_offset() * sample.normal;
    const std::optional<Hit> ahead = rays.first_hit(origin, sample.normal);
    if (ahead && (ahead->is_back_face || ahead->distance < kTouchingM)) return true;
    const std::optional<Hit> above = rays.first_hit(origin, {0.0f, 0.0f, 1.0f});
    if (!above) return false;
    const Face& face = scene.faces[scene.triangle_face[above->triangle].index()];
    // Within a row of houses the ray ahead meets two party walls in one place, of which either may be hit. The roof
    // above tells; but seen from below it may be an eave, under which a wall sees the sky.
    if (above->is_back_face)
        return is_ground(scene.objects[face.object].type) || !sees_sky(origin, sample.normal, rays);
    return face.type == SurfaceType::ground && above->distance < kCrawlM;
}

/// Removes enclosed samples; free points stay, wherever the user put them.
void drop_enclosed(ReceiverSet& set, const Scene& scene, const RayScene& rays) {
    std::vector<char> is_dropped(set.samples.size());
    tbb::parallel_for(std::size_t{0}, set.samples.size(), [&](std::size_t i) {
        const bool is_free = set.receivers[set.samples[i].receiver].kind == ReceiverKind::point;
        is_dropped[i] = !is_free && is_enclosed(set.samples[i], scene, rays);
    });
    std::vector<Sample> kept;
    std::vector<Receiver> receivers;
    for (Receiver& receiver : set.receivers) {
        const std::uint32_t begin = static_cast<std::uint32_t>(kept.size());
        for (std::uint32_t i = receiver.sample_begin; i < receiver.sample_end; ++i) {
            if (is_dropped[i]) continue;
            kept.push_back(set.samples[i]);
            kept.back().receiver = static_cast<std::uint32_t>(receivers.size());
        }
        const bool is_asked_for_by_name = receiver.kind == ReceiverKind::polygon;
        if (kept.size() == begin && !is_asked_for_by_name) continue;
        receiver.sample_begin = begin;
        receiver.sample_end = static_cast<std::uint32_t>(kept.size());
        receiver.area_m2 = 0.0;
        for (std::uint32_t i = begin; i < kept.size(); ++i) receiver.area_m2 += static_cast<double>(kept[i].area_m2);
        receivers.push_back(std::move(receiver));
    }
    set.enclosed = set.samples.size() - kept.size();
    set.samples = std::move(kept);
    set.receivers = std::move(receivers);
}

}  // namespace

const char* name_of(ReceiverKind kind) {
    switch (kind) {
        case ReceiverKind::ground:
            return "ground";
        case ReceiverKind::polygon:
            return "polygon";
        case ReceiverKind::roof:
            return "roof";
        case ReceiverKind::facade:
            return "facade";
        case ReceiverKind::window:
            return "window";
        case ReceiverKind::point:
            return "point";
    }
    return "";
}

ReceiverSet make_receivers(const Scene& scene, const RayScene& rays, const ReceiverOptions& options) {
    ReceiverSet set;
    set.cell_m = options.cell_m;
    const auto has = [&](ReceiverKind kind) {
        return std::find(options.kinds.begin(), options.kinds.end(), kind) != options.kinds.end();
    };
    if (has(ReceiverKind::ground)) add_ground_cells(set, scene, options);
    if (has(ReceiverKind::polygon)) add_polygon_cells(set, scene, options);
    for (const ReceiverKind kind : {ReceiverKind::roof, ReceiverKind::facade, ReceiverKind::window}) {
        if (has(kind)) add_surface_cells(set, scene, kind, options);
    }
    if (has(ReceiverKind::point)) {
        for (const StudyPoint& point : options.points) {
            const auto index = static_cast<std::uint32_t>(set.samples.size());
            Receiver receiver;
            receiver.id = point.id;
            receiver.kind = ReceiverKind::point;
            receiver.sample_begin = index;
            receiver.sample_end = index + 1;
            Sample sample;
            sample.position = point.position;
            sample.normal = Vec3f(point.normal);
            sample.receiver = static_cast<std::uint32_t>(set.receivers.size());
            set.samples.push_back(sample);
            set.receivers.push_back(std::move(receiver));
        }
    }
    drop_enclosed(set, scene, rays);
    return set;
}

}  // namespace skybake
