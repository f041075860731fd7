#include "light/flight.h"

#include <algorithm>
#include <cmath>

namespace skybake {

Rgb leaf_albedo(const Rgb& crown_albedo) {
    const Rgb gamma = (1.0f - crown_albedo) / (1.0f + crown_albedo);
    return 1.0f - gamma * gamma;
}

std::optional<SurfacePoint> Flight::end(const Vec3f& origin, const Vec3f& direction, RandomSequence& random) {
    passed_.clear();
    const std::optional<Hit> hit = rays_.first_hit(origin, direction);
    if (rays_.crowns()) {
        const float distance = hit ? hit->distance : std::numeric_limits<float>::infinity();
        rays_.crowns()->crossings(origin, direction, distance, crossings_);
        if (!crossings_.empty()) {
            const float depth = -std::log(1.0f - random.next());
            if (const auto leaf = leaf_on_the_way(origin, direction, distance, depth)) return leaf;
        }
    }
    if (!hit) return std::nullopt;
    return surface_point(scene_, *hit);
}

/// Where the optical depth from the origin reaches `depth`, if it does so before `distance`.
std::optional<SurfacePoint> Flight::leaf_on_the_way(const Vec3f& origin, const Vec3f& direction, float distance,
                                                    float depth) {
    const auto surface_at = [&](const CrownCrossing& crossing) {
        return surface_point(scene_,
                             {crossing.distance, crossing.triangle, crossing.u, crossing.v, !crossing.is_entry});
    };
    const auto leaf_at = [&](float where, const CrownCrossing& crossing) {
        const SurfacePoint surface = surface_at(crossing);
        return SurfacePoint{origin + where * direction, Vec3f(0.0f), leaf_albedo(surface.albedo), true};
    };
    float extinction = 0.0f;  // of all bodies about the place
    float place = 0.0f;
    const CrownCrossing* body = nullptr;  // entered last
    for (const CrownCrossing& crossing : crossings_) {
        const float next = std::clamp(crossing.distance, 0.0f, distance);
        const float on_the_way = std::max(0.0f, extinction) * (next - place);
        if (body && on_the_way > depth) return leaf_at(place + depth / extinction, *body);
        depth -= on_the_way;
        place = next;
        if (crossing.distance >= distance) return std::nullopt;
        const bool is_ahead = crossing.distance > 0.0f;
        if (is_ahead && (crossing.is_entry || crossing.depth > 0.0f)) passed_.push_back(surface_at(crossing));
        if (is_ahead && crossing.depth > 0.0f) {
            if (crossing.depth > depth) return leaf_at(place, crossing);
            depth -= crossing.depth;
        }
        extinction += crossing.is_entry ? crossing.extinction : -crossing.extinction;
        if (crossing.is_entry && crossing.extinction > 0.0f) body = &crossing;
    }
    if (distance == std::numeric_limits<float>::infinity()) return std::nullopt;
    // A body that the way ends in: its far side was not looked for.
    const float rest = std::max(0.0f, extinction) * (distance - place);
    if (body && extinction > 0.0f && rest > depth) return leaf_at(place + depth / extinction, *body);
    return std::nullopt;
}

}  // namespace skybake
