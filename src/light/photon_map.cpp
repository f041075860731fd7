#include "light/photon_map.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/box.h"
#include "base/check.h"

namespace skybake {

namespace {

// Photons that are looked through one by one: half a cache line of distances.
constexpr std::size_t kLeaf = 8;
// Ranges above this are worth a task.
constexpr std::size_t kParallel = 16384;
constexpr float kSameSideCosine = 0.9063f;  // cos 25°: as the charts' smooth seams
constexpr float kOffPlane = 0.02f, kOffPlaneSlope = 0.1f;
// Half of an octagon's diagonal over its inner radius: 1/cos(22.5°). With what the plane's tolerance adds, a photon of
// surface distance d is never farther than 1.1 d + 0.03 m.
constexpr float kReachFactor = 1.1f, kReachOffset = 0.03f;

void sort_range(std::span<Photon> range) {
    if (range.size() <= kLeaf) return;
    Box3f box;
    for (const Photon& photon : range) box.extend(photon.position);
    const Vec3f size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = range.size() / 2;
    std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(middle), range.end(),
                     [axis](const Photon& a, const Photon& b) {
                         return std::tie(a.position[axis], a.position.x, a.position.y, a.position.z) <
                                std::tie(b.position[axis], b.position.x, b.position.y, b.position.z);
                     });
    range[middle].set_split_axis(axis);
    const std::span<Photon> below = range.first(middle), above = range.subspan(middle + 1);
    if (range.size() > kParallel) {
        tbb::parallel_invoke([&] { sort_range(below); }, [&] { sort_range(above); });
    } else {
        sort_range(below);
        sort_range(above);
    }
}

bool is_farther_last(const NearPhoton& a, const NearPhoton& b) {
    return std::tie(a.distance, a.photon) < std::tie(b.distance, b.photon);
}

class Search {
  public:
    Search(std::span<const Photon> photons, const Vec3f& position, const Vec3f& normal, SurfaceMetric metric,
           std::size_t count, float max_distance, const SurfaceLimits& limit, std::vector<NearPhoton>& found)
        : photons_(photons),
          position_(position),
          normal_(normal),
          axes_(surface_axes(normal)),
          metric_(metric),
          count_(count),
          reach_(max_distance),
          limit_(limit),
          found_(found) {
        found_.clear();
        search(0, photons.size());
        std::sort_heap(found_.begin(), found_.end(), is_farther_last);
        std::reverse(found_.begin(), found_.end());
    }

  private:
    void search(std::size_t begin, std::size_t end) {
        if (end - begin <= kLeaf) {
            for (std::size_t i = begin; i < end; ++i) consider(i);
            return;
        }
        const std::size_t middle = begin + (end - begin) / 2;
        const int axis = photons_[middle].split_axis();
        const float off = position_[axis] - photons_[middle].position[axis];
        if (off < 0.0f) {
            search(begin, middle);
            if (-off > kReachFactor * reach_ + kReachOffset) return;
            consider(middle);
            search(middle + 1, end);
        } else {
            search(middle + 1, end);
            if (off > kReachFactor * reach_ + kReachOffset) return;
            consider(middle);
            search(begin, middle);
        }
    }

    void consider(std::size_t index) {
        const Photon& photon = photons_[index];
        const Vec3f off = photon.position - position_;
        const Vec2f offset(glm::dot(off, axes_.u), glm::dot(off, axes_.v));
        const float a = std::abs(offset.x), b = std::abs(offset.y);
        const float distance = metric_ == SurfaceMetric::circle
                                   ? std::sqrt(a * a + b * b)
                                   : std::max({a, b, (a + b) * static_cast<float>(0.70710678118654752)});
        if (!(distance < reach_) || std::abs(glm::dot(off, normal_)) > kOffPlane + kOffPlaneSlope * distance ||
            glm::dot(photon.normal(), normal_) < kSameSideCosine)
            return;
        for (std::size_t k = 0; k < limit_.size(); ++k) {
            if (glm::dot(offset, surface_direction(k)) > limit_[k]) return;
        }
        if (found_.size() == count_) {
            std::pop_heap(found_.begin(), found_.end(), is_farther_last);
            found_.pop_back();
        }
        found_.push_back({distance, offset, static_cast<std::uint32_t>(index)});
        std::push_heap(found_.begin(), found_.end(), is_farther_last);
        if (found_.size() == count_) reach_ = found_.front().distance;
    }

    std::span<const Photon> photons_;
    Vec3f position_, normal_;
    SurfaceAxes axes_;
    SurfaceMetric metric_;
    std::size_t count_;
    float reach_;
    SurfaceLimits limit_;
    std::vector<NearPhoton>& found_;
};

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

PhotonMap::PhotonMap(std::vector<Photon> photons) : photons_(std::move(photons)) {
    sort_range(photons_);
}

void PhotonMap::find_nearest(const Vec3f& position, const Vec3f& normal, SurfaceMetric metric, std::size_t count,
                             float max_distance, const SurfaceLimits& limit, std::vector<NearPhoton>& found) const {
    SKYBAKE_CHECK_LT(std::size_t{0}, count);
    Search(photons_, position, normal, metric, count, max_distance, limit, found);
}

}  // namespace skybake
