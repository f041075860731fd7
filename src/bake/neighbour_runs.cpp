#include "bake/neighbour_runs.h"

#include <algorithm>

#include "base/box.h"
#include "base/check.h"

namespace skybake {

NeighbourRuns::NeighbourRuns(std::span<const Vec3f> points, std::span<const std::uint32_t> chosen, std::size_t longest)
    : order_(chosen.begin(), chosen.end()), begin_{0} {
    SKYBAKE_CHECK_LE(1u, longest);
    const auto halve = [&](const auto& self, std::span<std::uint32_t> run) -> void {
        if (run.size() <= longest) {
            if (!run.empty()) begin_.push_back(begin_.back() + static_cast<std::uint32_t>(run.size()));
            return;
        }
        Box3f box;
        for (const std::uint32_t i : run) box.extend(points[i]);
        const Vec3f size = box.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto middle = run.begin() + static_cast<std::ptrdiff_t>(run.size() / 2);
        std::nth_element(run.begin(), middle, run.end(), [&](std::uint32_t a, std::uint32_t b) {
            return points[a][axis] != points[b][axis] ? points[a][axis] < points[b][axis] : a < b;
        });
        self(self, run.first(run.size() / 2));
        self(self, run.subspan(run.size() / 2));
    };
    halve(halve, order_);
}

}  // namespace skybake
