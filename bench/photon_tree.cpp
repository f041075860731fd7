// Our kd-tree of photons against nanoflann's: time to build, memory, time for a hundred nearest, the same answers.
//   bench_photon_tree CITY [QUERIES]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <nanoflann.hpp>

#include "bench_city.h"
#include "light/photon_tracer.h"
#include "surface_points.h"

namespace skybake::bench {
namespace {

constexpr std::size_t kNearest = 100;
constexpr float kMaxDistance = 10.0f;

/// Processor time of all threads: other programs on the machine do not count.
double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Photons as nanoflann reads them.
struct Cloud {
    const std::vector<Photon>& photons;
    std::size_t kdtree_get_point_count() const { return photons.size(); }
    float kdtree_get_pt(std::uint32_t i, std::size_t axis) const { return photons[i].position[static_cast<int>(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3, std::uint32_t>;

/// The same choice of photons as PhotonSearch::nearest with the circle's metric and no limits.
class SameSurface {
  public:
    SameSurface(const std::vector<Photon>& photons, const ReceiverPoint& point)
        : photons_(photons), point_(point), axes_(surface_axes(point.normal)) {}

    bool addPoint(float, std::uint32_t i) {
        const Photon& photon = photons_[i];
        const Vec3f off = photon.position - point_.position;
        const Vec2f offset(glm::dot(off, axes_.u), glm::dot(off, axes_.v));
        const float distance = glm::length(offset);
        if (!(distance < reach_) || std::abs(glm::dot(off, point_.normal)) > 0.02f + 0.1f * distance ||
            glm::dot(photon.normal(), point_.normal) < 0.9063f)
            return true;
        if (heap_.size() == kNearest) {
            std::pop_heap(heap_.begin(), heap_.end());
            heap_.pop_back();
        }
        heap_.push_back(distance);
        std::push_heap(heap_.begin(), heap_.end());
        if (heap_.size() == kNearest) reach_ = heap_.front();
        return true;
    }
    float worstDist() const {
        const float reach = 1.1f * reach_ + 0.03f;
        return reach * reach;
    }
    bool full() const { return true; }
    std::size_t size() const { return heap_.size(); }
    float farthest() const { return heap_.empty() ? 0.0f : heap_.front(); }

  private:
    const std::vector<Photon>& photons_;
    ReceiverPoint point_;
    SurfaceAxes axes_;
    float reach_ = kMaxDistance;
    std::vector<float> heap_;
};

int run(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: bench_photon_tree CITY [QUERIES]\n");
        return 2;
    }
    const Scene scene = load_scene(argv[1], 1e6, 0.5f);
    const RayScene rays(scene);
    const LightSources sources{afternoon(), {}};
    const std::size_t queries = argc > 2 ? static_cast<std::size_t>(std::atoll(argv[2])) : 20000;
    const std::vector<ReceiverPoint> points = surface_points(scene, rays, sources.daylight, queries, 0.0f, 64).points;
    fmt::print(
        "| photons at rest | tree | build, CPU s | bytes a photon | CPU µs a query | farthest photons agree "
        "|\n|---|---|---|---|---|---|\n");
    for (const std::size_t wanted : {std::size_t{1'000'000}, std::size_t{10'000'000}}) {
        SilentProgress silent;
        // About as many come to rest as are sent.
        std::vector<Photon> photons = trace_photons(sources, scene, rays, {2 * wanted, 8, 0}, silent).photons;

        double begin = processor_seconds();
        const Cloud cloud{photons};
        Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(8));
        tree.buildIndex();
        const double theirs_build = (processor_seconds() - begin);
        std::vector<float> theirs;
        begin = processor_seconds();
        for (const ReceiverPoint& point : points) {
            SameSurface found(photons, point);
            tree.findNeighbors(found, &point.position.x, nanoflann::SearchParams());
            theirs.push_back(found.farthest());
        }
        const double theirs_us = 1e6 * (processor_seconds() - begin) / static_cast<double>(points.size());
        const double theirs_bytes = static_cast<double>(tree.usedMemory(tree)) / static_cast<double>(photons.size());

        std::vector<Photon> copy = photons;
        begin = processor_seconds();
        const PhotonMap map(std::move(copy));
        const double ours_build = (processor_seconds() - begin);
        std::size_t agreeing = 0;
        PhotonSearch search(map);
        begin = processor_seconds();
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::span<const NearPhoton> found = search.nearest(
                {points[i].position, points[i].normal, SurfaceMetric::circle, kNearest, kMaxDistance, no_limits()});
            agreeing += std::abs((found.empty() ? 0.0f : found.front().distance) - theirs[i]) < 1e-5f;
        }
        const double ours_us = 1e6 * (processor_seconds() - begin) / static_cast<double>(points.size());
        fmt::print("| {} | nanoflann | {:.2f} | {} + {:.0f} | {:.1f} | |\n", photons.size(), theirs_build,
                   sizeof(Photon), theirs_bytes, theirs_us);
        fmt::print("| {} | ours | {:.2f} | {} | {:.1f} | {} of {} |\n", photons.size(), ours_build, sizeof(Photon),
                   ours_us, agreeing, points.size());
    }
    return 0;
}

}  // namespace
}  // namespace skybake::bench

int main(int argc, char** argv) {
    return skybake::bench::run(argc, argv);
}
