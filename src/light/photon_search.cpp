#include "light/photon_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "light/photon_kernels.h"

namespace skybake {

namespace {

// The first radius of a point that lies far from the last one, as a share of the greatest radius; doubled until enough
// photons are found, which costs a third more than to know it.
constexpr float kFirstGuess = 1.0f / 16.0f;
// The next point's photons are expected within this many radii of the last
// one's.
constexpr float kGuess = 1.15f;
// Closer than this many radii to the last point is close.
constexpr float kClose = 2.0f;
// How many radii a patch reaches from the point that it is taken for: just enough for one that lies far from the last
// point; where points lie close, enough for those that follow.
constexpr float kOwnRadii = 1.15f, kSharedRadii = 3.6f;
// A shared patch serves radii up to this many times the first one's: behind a feeler's wall photons are looked for
// twice as far.
constexpr float kMostGrowth = 2.1f;
// Where a third of that would do, photons lie too dense to look through all of
// the patch.
constexpr float kMostFall = 0.3f;
// A patch answers for points whose normal differs from its own by less
// than 2.5°.
constexpr float kPatchCosine = 0.999f;
// Photons in the patch differ from its normal by less than 25° + 2.5°, rounded
// up.
constexpr float kTakenCosine = 0.88f;

/// How far off the plane of a patch the points may lie that it answers for,
/// metres.
float point_height(float reach) {
    return 0.01f + 0.01f * reach;
}

}  // namespace

SurfaceAxes surface_axes(const Vec3f& normal) {
    const float level = std::hypot(normal.x, normal.y);
    // Within half a degree of level, a wall's horizontal would be noise.
    const Vec3f u = level > 0.01f ? Vec3f(-normal.y / level, normal.x / level, 0.0f)
                                  : glm::normalize(glm::cross(Vec3f(0, 1, 0), normal));
    return {u, glm::cross(normal, u)};
}

SurfaceLimits no_limits() {
    SurfaceLimits limits;
    limits.fill(std::numeric_limits<float>::infinity());
    return limits;
}

Vec2f surface_direction(std::size_t k) {
    static constexpr float kRoot = 0.70710678118654752f;
    static constexpr std::array<float, 8> kCosine{1, kRoot, 0, -kRoot, -1, -kRoot, 0, kRoot};
    return {kCosine[k], kCosine[(k + 6) % 8]};
}

std::span<const NearPhoton> PhotonSearch::nearest(const PhotonQuery& query) {
    SKYBAKE_CHECK_LT(std::size_t{0}, query.count);
    // What limits keep away is made up for by what lies farther: all of the way may be needed.
    const bool is_limited =
        std::any_of(query.limit.begin(), query.limit.end(), [](float limit) { return std::isfinite(limit); });
    const bool is_close = glm::distance(query.position, last_position_) < kClose * last_radius_;
    float radius = is_limited ? query.max_distance
                   : is_close ? kGuess * last_radius_
                              : kFirstGuess * query.max_distance;
    radius = std::min(radius, query.max_distance);
    for (;; radius = std::min(2.0f * radius, query.max_distance)) {
        if (!covers(query, radius)) take_patch(query, radius, is_close && !is_limited);
        find_within(query, radius);
        if (found_.size() >= query.count || radius >= query.max_distance) break;
    }
    keep_nearest(query.count);
    last_position_ = query.position;
    if (!is_limited) last_radius_ = found_.size() == query.count ? found_.front().distance : radius;
    return found_;
}

/// Photons of distance d ≤ r lie within 1.083 r in the point's plane and 0.02 m + 0.1 r off it: within 1.1 r + 0.01 m of
/// the point as the patch's axes see it.
bool PhotonSearch::covers(const PhotonQuery& query, float radius) const {
    if (!(radius <= most_radius_) || radius < kMostFall * most_radius_) return false;
    if (glm::dot(query.normal, normal_) < kPatchCosine) return false;
    const Vec3f off = query.position - center_;
    const float along = std::max(std::abs(glm::dot(off, axes_.u)), std::abs(glm::dot(off, axes_.v)));
    return along + 1.1f * radius + 0.01f <= reach_ && std::abs(glm::dot(off, normal_)) <= point_height(reach_);
}

/// Off the patch's plane lie at most the point, its photons (0.02 m + 0.1 r), and what 2.5° between the planes make of
/// 1.2 r.
void PhotonSearch::take_patch(const PhotonQuery& query, float radius, bool is_shared) {
    most_radius_ = is_shared ? kMostGrowth * radius : radius;
    reach_ = (is_shared ? kSharedRadii : kOwnRadii) * radius + 0.02f;
    center_ = query.position;
    normal_ = query.normal;
    axes_ = surface_axes(normal_);
    const float height = point_height(reach_) + 0.025f + 0.16f * most_radius_;
    const OrientedBox box{center_, {axes_.u, axes_.v, normal_}, {reach_, reach_, height}};
    in_box_.clear();
    map_.find_in(box, in_box_);
    for (std::vector<float>* array : {&x_, &y_, &z_, &normal_x_, &normal_y_, &normal_z_}) array->clear();
    photon_.clear();
    for (const std::uint32_t i : in_box_) {
        const Photon& photon = map_.photons()[i];
        const Vec3f n = photon.normal();
        if (glm::dot(n, normal_) < kTakenCosine) continue;
        x_.push_back(photon.position.x);
        y_.push_back(photon.position.y);
        z_.push_back(photon.position.z);
        normal_x_.push_back(n.x);
        normal_y_.push_back(n.y);
        normal_z_.push_back(n.z);
        photon_.push_back(i);
    }
    const std::size_t padded =
        (photon_.size() + PatchArrays::kPadding - 1) / PatchArrays::kPadding * PatchArrays::kPadding;
    for (std::vector<float>* array : {&x_, &y_, &z_, &normal_x_, &normal_y_, &normal_z_}) array->resize(padded);
}

void PhotonSearch::find_within(const PhotonQuery& query, float radius) {
    const PatchArrays patch{x_, y_, z_, normal_x_, normal_y_, normal_z_, photon_};
    find_photons_within(patch, query, surface_axes(query.normal), radius, found_);
}

void PhotonSearch::keep_nearest(std::size_t count) {
    if (found_.empty()) return;
    if (found_.size() > count) {
        distance_.clear();
        for (const NearPhoton& photon : found_) distance_.push_back(photon.distance);
        const auto last = distance_.begin() + static_cast<std::ptrdiff_t>(count - 1);
        std::nth_element(distance_.begin(), last, distance_.end());
        const float farthest = *last;
        // Of those at the very same distance the first in the map.
        std::size_t at_last = count - static_cast<std::size_t>(std::count_if(distance_.begin(), distance_.end(),
                                                                             [&](float d) { return d < farthest; }));
        std::erase_if(found_, [&](const NearPhoton& photon) {
            if (photon.distance < farthest) return false;
            if (photon.distance > farthest || at_last == 0) return true;
            --at_last;
            return false;
        });
    }
    const auto farthest = std::max_element(
        found_.begin(), found_.end(), [](const NearPhoton& a, const NearPhoton& b) { return a.distance < b.distance; });
    std::rotate(found_.begin(), farthest, farthest + 1);
}

}  // namespace skybake
