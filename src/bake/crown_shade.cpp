#include "bake/crown_shade.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "bake/sky_accumulator.h"
#include "bake/sky_tile.h"

namespace skybake {

namespace {

constexpr std::size_t kConeDirections = 16;
constexpr int kBlock = 16;  // texels a side
// Crowns further from the tile than so many of its radii, and theirs, look alike from all of its blocks.
constexpr float kFar = 6.0f;

std::vector<std::uint32_t> all_of(const DomeSamples& dome) {
    std::vector<std::uint32_t> all(dome.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

struct Sphere {
    Vec3f center{0.0f};
    float radius = 0.0f;
    bool is_empty = true;
};

/// About the covered texels of a part of the tile.
Sphere sphere_about(const TilePoints& points, int column0, int row0, int column1, int row1) {
    Box3f box;
    const auto for_covered = [&](const auto& body) {
        for (int row = row0; row < row1; ++row) {
            for (int column = column0; column < column1; ++column) {
                if (!(points.covered[static_cast<std::size_t>(row)] >> column & 1)) continue;
                const std::size_t t = static_cast<std::size_t>(points.texel(column, row));
                body(Vec3f(points.x[t], points.y[t], points.z[t]));
            }
        }
    };
    for_covered([&](const Vec3f& p) { box.extend(p); });
    if (box.is_empty()) return {};
    Sphere sphere{box.center(), 0.0f, false};
    for_covered([&](const Vec3f& p) { sphere.radius = std::max(sphere.radius, glm::length(p - sphere.center)); });
    return sphere;
}

}  // namespace

DirectionCones::DirectionCones(const DomeSamples& dome) : runs_(dome.directions, all_of(dome), kConeDirections) {
    for (std::size_t r = 0; r < runs_.size(); ++r) {
        Vec3f sum(0.0f);
        for (const std::uint32_t j : runs_[r]) sum += dome.directions[j];
        Cone cone{glm::normalize(sum), 0.0f};
        for (const std::uint32_t j : runs_[r]) {
            const float cosine = std::clamp(glm::dot(cone.axis, dome.directions[j]), -1.0f, 1.0f);
            cone.half_angle = std::max(cone.half_angle, std::acos(cosine));
        }
        cone.half_angle += 1e-3f;  // more than acos loses near 1
        cones_.push_back(cone);
    }
}

void DirectionCones::mark(const Crown& crown, const Vec3f& center, float radius,
                          std::vector<std::uint8_t>& meets) const {
    const Vec3f to_crown = crown.center - center;
    const float distance = glm::length(to_crown), reach = crown.radius + radius;
    const float half_angle = distance > reach ? std::asin(reach / distance) : static_cast<float>(kPi);
    for (std::size_t r = 0; r < cones_.size(); ++r) {
        const float widest = half_angle + cones_[r].half_angle;
        if (widest < static_cast<float>(kPi) && glm::dot(cones_[r].axis, to_crown) < std::cos(widest) * distance)
            continue;
        for (const std::uint32_t j : runs_[r]) meets[j] = 1;
    }
}

CrownShade::CrownShade(const TilePoints& points, const DomeSamples& dome, const DirectionCones& cones,
                       const CrownVolume& crowns, DirectionPacket& packet)
    : points_(points), dome_(dome), packet_(packet), meets_(dome.size(), 0) {
    const Sphere tile = sphere_about(points, 0, 0, points.width, points.height);
    if (tile.is_empty) return;
    std::vector<std::uint8_t> far(dome.size(), 0);
    std::vector<const Crown*> near;
    for (const Crown& crown : crowns.crowns()) {
        if (glm::length(crown.center - tile.center) > kFar * (tile.radius + crown.radius)) {
            cones.mark(crown, tile.center, tile.radius, far);
        } else {
            near.push_back(&crown);
        }
    }
    for (int row = 0; row < points.height; row += kBlock) {
        for (int column = 0; column < points.width; column += kBlock) {
            const Sphere block = sphere_about(points, column, row, std::min(column + kBlock, points.width),
                                              std::min(row + kBlock, points.height));
            if (block.is_empty) continue;
            blocks_.push_back({column, row, far});
            for (const Crown* crown : near) cones.mark(*crown, block.center, block.radius, blocks_.back().meets);
            for (std::size_t j = 0; j < dome.size(); ++j) meets_[j] |= blocks_.back().meets[j];
        }
    }
}

std::uint64_t CrownShade::dim(std::size_t j, std::span<const std::uint64_t> visible, SkyAccumulator& sum) {
    if (!meets_[j]) return 0;
    constexpr int kPacket = RayScene::kPacketSize;
    float x[kPacket], y[kPacket], z[kPacket], share[kPacket];
    std::size_t texel[kPacket];
    std::uint64_t rays = 0;
    int count = 0;
    const auto trace = [&] {
        if (count == 0) return;
        packet_.transmittance(x, y, z, ~0u, count, share);
        for (int i = 0; i < count; ++i) {
            if (share[i] < 1.0f) sum.dim(j, texel[i], 1.0f - share[i]);
        }
        rays += static_cast<std::uint64_t>(count);
        count = 0;
    };
    packet_.set_direction(dome_.directions[j]);
    for (const Block& block : blocks_) {
        if (!block.meets[j]) continue;
        for (int row = block.row; row < std::min(block.row + kBlock, points_.height); ++row) {
            const std::size_t r = static_cast<std::size_t>(row);
            std::uint64_t left = visible[r] & points_.covered[r] & (((1ull << kBlock) - 1) << block.column);
            for (; left; left &= left - 1) {
                const std::size_t t = static_cast<std::size_t>(points_.texel(std::countr_zero(left), row));
                x[count] = points_.x[t];
                y[count] = points_.y[t];
                z[count] = points_.z[t];
                texel[count] = t;
                if (++count == kPacket) trace();
            }
        }
        trace();
    }
    return rays;
}

}  // namespace skybake
