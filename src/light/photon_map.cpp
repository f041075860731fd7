#include "light/photon_map.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace skybake {

namespace {

// Photons that are looked through one by one: half a cache line of distances.
constexpr std::size_t kLeaf = 8;
// Ranges above this are worth a task.
constexpr std::size_t kParallel = 16384;

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

class Search {
  public:
    Search(std::span<const Photon> photons, const OrientedBox& box, std::vector<std::uint32_t>& found)
        : photons_(photons), box_(box), found_(found) {
        run(0, photons.size(), box.bounds());
    }

  private:
    /// `cell` holds what of the box's bounds the range may lie in.
    void run(std::size_t begin, std::size_t end, const Box3f& cell) {
        if (end - begin <= kLeaf) {
            for (std::size_t i = begin; i < end; ++i) consider(i);
            return;
        }
        if (box_.misses(cell)) return;
        const std::size_t middle = begin + (end - begin) / 2;
        const int axis = photons_[middle].split_axis();
        const float cut = photons_[middle].position[axis];
        if (cell.lo[axis] <= cut) {
            Box3f below = cell;
            below.hi[axis] = std::min(cut, cell.hi[axis]);
            run(begin, middle, below);
        }
        consider(middle);
        if (cut <= cell.hi[axis]) {
            Box3f above = cell;
            above.lo[axis] = std::max(cut, cell.lo[axis]);
            run(middle + 1, end, above);
        }
    }

    void consider(std::size_t i) {
        if (box_.contains(photons_[i].position)) found_.push_back(static_cast<std::uint32_t>(i));
    }

    std::span<const Photon> photons_;
    const OrientedBox& box_;
    std::vector<std::uint32_t>& found_;
};

}  // namespace

PhotonMap::PhotonMap(std::vector<Photon> photons) : photons_(std::move(photons)) {
    sort_range(photons_);
}

void PhotonMap::find_in(const OrientedBox& box, std::vector<std::uint32_t>& found) const {
    Search(photons_, box, found);
}

Box3f OrientedBox::bounds() const {
    Vec3f reach(0.0f);
    for (int k = 0; k < 3; ++k) reach += half[k] * glm::abs(axis[static_cast<std::size_t>(k)]);
    return {center - reach, center + reach};
}

bool OrientedBox::contains(const Vec3f& p) const {
    const Vec3f off = p - center;
    return std::abs(glm::dot(off, axis[2])) <= half.z && std::abs(glm::dot(off, axis[0])) <= half.x &&
           std::abs(glm::dot(off, axis[1])) <= half.y;
}

bool OrientedBox::misses(const Box3f& box) const {
    const Vec3f off = box.center() - center, reach = 0.5f * box.size();
    for (int k = 0; k < 3; ++k) {
        const Vec3f& a = axis[static_cast<std::size_t>(k)];
        if (std::abs(glm::dot(off, a)) > half[k] + glm::dot(reach, glm::abs(a))) return true;
    }
    return false;
}

}  // namespace skybake
