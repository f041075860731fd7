#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/hash_rng.h"
#include "city/combine.h"
#include "city/finding_codes.h"
#include "city/polygon.h"
#include "city/repair_steps.h"

namespace skybake::repair_steps {
namespace {

/// Vertices this close are one: a millimetre, the resolution of most files, and a little for its rounding.
constexpr double kMergeDistance = 1.05e-3;
/// Cells larger than the distance, so that most vertices lie far from a cell's border and look into one cell only.
constexpr double kCell = 8 * kMergeDistance;
/// A polygon narrower than this on the mean is a line. Metres.
constexpr double kLeastWidth = 1e-4;

/// Finds an earlier vertex within kMergeDistance.
class VertexGrid {
  public:
    explicit VertexGrid(const std::vector<Vec3d>& vertices) : vertices_(vertices), next_(vertices.size(), kNone) {
        cells_.reserve(vertices.size());
    }

    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::uint32_t find(const Vec3d& p) const {
        const Vec3d lo = glm::floor((p - kMergeDistance) / kCell);
        const Vec3d hi = glm::floor((p + kMergeDistance) / kCell);
        for (double x = lo.x; x <= hi.x; ++x) {
            for (double y = lo.y; y <= hi.y; ++y) {
                for (double z = lo.z; z <= hi.z; ++z) {
                    const auto cell = cells_.find(key({x, y, z}));
                    for (std::uint32_t i = cell == cells_.end() ? kNone : cell->second; i != kNone; i = next_[i]) {
                        const Vec3d d = vertices_[i] - p;
                        if (glm::dot(d, d) <= kMergeDistance * kMergeDistance) return i;
                    }
                }
            }
        }
        return kNone;
    }
    void insert(std::uint32_t i) {
        const auto [cell, is_new] = cells_.emplace(key(glm::floor(vertices_[i] / kCell)), i);
        if (!is_new) {
            next_[i] = cell->second;
            cell->second = i;
        }
    }

  private:
    static std::uint64_t key(const Vec3d& cell) {
        const auto whole = [](double v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)); };
        return hash_combine(hash_combine(whole(cell.x), whole(cell.y)), whole(cell.z));
    }
    const std::vector<Vec3d>& vertices_;
    std::vector<std::uint32_t> next_;
    std::unordered_map<std::uint64_t, std::uint32_t> cells_;
};

/// No object is wider or higher than this about its middle. Metres.
constexpr double kWidestObject = 500'000.0;
constexpr double kHighestObject = 20'000.0;

struct Corner {
    std::uint32_t vertex;
    Vec2f uv;
};

/// Takes repeated corners and spikes (a, b, and back towards a) out of a ring.
bool clean_ring(std::vector<Corner>& ring, const std::vector<Vec3d>& vertices) {
    const std::size_t before = ring.size();
    const auto is_spike = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a == b || b == c || a == c) return true;
        const Vec3d u = vertices[b] - vertices[a];
        const Vec3d v = vertices[c] - vertices[b];
        if (glm::dot(u, v) >= 0.0) return false;
        // The way back runs along the way there: c, or a, lies on the other's line.
        return glm::length(glm::cross(u, v)) <= kLeastWidth * std::max(glm::length(u), glm::length(v));
    };
    std::vector<Corner> kept;
    kept.reserve(ring.size());
    for (const Corner& corner : ring) {
        kept.push_back(corner);
        while (kept.size() >= 2) {
            const std::size_t n = kept.size();
            if (kept[n - 1].vertex == kept[n - 2].vertex) {
                kept.pop_back();
            } else if (n >= 3 && is_spike(kept[n - 3].vertex, kept[n - 2].vertex, kept[n - 1].vertex)) {
                kept.erase(kept.end() - 2);
            } else {
                break;
            }
        }
    }
    // The same across the seam.
    std::size_t begin = 0;
    for (bool is_changed = true; is_changed && kept.size() - begin >= 3;) {
        const std::size_t n = kept.size();
        if (kept[n - 1].vertex == kept[begin].vertex ||
            is_spike(kept[n - 2].vertex, kept[n - 1].vertex, kept[begin].vertex)) {
            kept.pop_back();
        } else if (is_spike(kept[n - 1].vertex, kept[begin].vertex, kept[begin + 1].vertex)) {
            ++begin;
        } else {
            is_changed = false;
        }
    }
    kept.erase(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(begin));
    ring = std::move(kept);
    return ring.size() != before;
}

}  // namespace

bool is_place(const Vec3d& p) {
    const auto is_good = [](double v) { return std::isfinite(v) && std::abs(v) <= 1e9; };
    return is_good(p.x) && is_good(p.y) && is_good(p.z);
}

void drop_bad_coordinates(CityObject& object, FindingLog& findings) {
    Geometry& g = object.geometry;
    if (g.vertices.empty()) return;
    // The middle of what is a place at all; a single wild vertex does not move a median.
    Vec3d median(0.0);
    std::vector<double> values;
    for (int axis = 0; axis < 3; ++axis) {
        values.clear();
        for (const Vec3d& p : g.vertices) {
            if (is_place(p)) values.push_back(p[axis]);
        }
        if (values.empty()) break;
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        median[axis] = *middle;
    }
    const auto is_bad = [&](const Vec3d& p) {
        const Vec3d d = glm::abs(p - median);
        return !is_place(p) || d.x > kWidestObject || d.y > kWidestObject || d.z > kHighestObject;
    };
    std::vector<char> keep(g.surfaces.size(), 1);
    std::size_t dropped = 0;
    Vec3d place(0.0);
    for (std::size_t i = 0; i < g.surfaces.size(); ++i) {
        const Surface& surface = g.surfaces[i];
        for (std::uint32_t c = g.ring_first[surface.ring_begin]; keep[i] && c < g.ring_first[surface.ring_end]; ++c) {
            const Vec3d& p = g.vertices[g.corners[c]];
            if (!is_bad(p)) continue;
            keep[i] = 0;
            if (dropped++ == 0) place = p;
        }
    }
    if (dropped == 0) return;
    findings.add(
        make_finding("SB211", object.where,
                     fmt::format("a vertex lies at ({}, {}, {}); {} of {} surfaces with such vertices are left out.",
                                 place.x, place.y, place.z, dropped, g.surfaces.size())));
    keep_surfaces(g, keep);
    drop_unused_vertices(g);
}

void merge_vertices(CityObject& object, FindingLog& findings) {
    Geometry& g = object.geometry;
    constexpr std::uint32_t kNone = VertexGrid::kNone;
    std::vector<std::uint32_t> merged(g.vertices.size(), kNone);
    VertexGrid grid(g.vertices);
    std::size_t moved = 0;
    Vec3d first_place(0.0);
    std::vector<std::uint32_t> renumbered(g.vertices.size(), kNone);
    std::vector<Vec3d> kept;
    for (std::uint32_t& corner : g.corners) {
        if (merged[corner] == kNone) {
            const std::uint32_t earlier = grid.find(g.vertices[corner]);
            merged[corner] = earlier == kNone ? corner : earlier;
            if (earlier == kNone) {
                grid.insert(corner);
                renumbered[corner] = static_cast<std::uint32_t>(kept.size());
                kept.push_back(g.vertices[corner]);
            } else if (g.vertices[earlier] != g.vertices[corner] && moved++ == 0) {
                first_place = g.vertices[corner];
            }
        }
        corner = renumbered[merged[corner]];
    }
    g.vertices = std::move(kept);
    if (moved > 0) {
        findings.add(make_finding(
            "SB210", object.where,
            fmt::format("{} vertices up to 1 mm beside another were merged, the first at ({:.3f}, {:.3f}, {:.3f}).",
                        moved, first_place.x, first_place.y, first_place.z)));
    }
}

void clean_rings(CityObject& object, FindingLog& findings) {
    Geometry& g = object.geometry;
    Geometry clean;
    clean.vertices = std::move(g.vertices);
    clean.corners.reserve(g.corners.size());
    clean.surfaces.reserve(g.surfaces.size());
    clean.ring_first.reserve(g.ring_first.size());
    std::vector<Corner> ring;
    std::size_t cleaned = 0;
    for (const Shell& from : g.shells) {
        Shell shell = from;
        shell.surface_begin = static_cast<std::uint32_t>(clean.surfaces.size());
        for (std::uint32_t s = from.surface_begin; s < from.surface_end; ++s) {
            Surface surface = g.surfaces[s];
            const std::uint32_t ring_begin = static_cast<std::uint32_t>(clean.ring_first.size() - 1);
            bool is_good = true;
            for (std::uint32_t r = surface.ring_begin; r < surface.ring_end; ++r) {
                ring.clear();
                for (std::uint32_t c = g.ring_first[r]; c < g.ring_first[r + 1]; ++c)
                    ring.push_back({g.corners[c], g.corner_uv.empty() ? Vec2f(0.0f) : g.corner_uv[c]});
                cleaned += clean_ring(ring, clean.vertices);
                if (ring.size() < 3) {
                    if (r == surface.ring_begin) is_good = false;
                    if (!is_good) break;
                    continue;  // a hole without area
                }
                for (const Corner& corner : ring) {
                    clean.corners.push_back(corner.vertex);
                    if (!g.corner_uv.empty()) clean.corner_uv.push_back(corner.uv);
                }
                clean.ring_first.push_back(static_cast<std::uint32_t>(clean.corners.size()));
                if (r == surface.ring_begin) {
                    // Without signs: a bow tie's halves may cancel, and it is no line.
                    const Vec3d first = clean.vertices[ring[0].vertex];
                    double area = 0.0;
                    double longest = 0.0;
                    for (std::size_t i = 1; i < ring.size(); ++i) {
                        const Vec3d arm = clean.vertices[ring[i].vertex] - first;
                        area += 0.5 * glm::length(glm::cross(clean.vertices[ring[i - 1].vertex] - first, arm));
                        longest = std::max(longest, glm::length(arm));
                    }
                    if (!(area > kLeastWidth * longest)) {
                        is_good = false;
                        break;
                    }
                }
            }
            if (!is_good) {
                const Vec3d p = clean.vertices[g.corners[g.ring_first[surface.ring_begin]]];
                findings.add(make_finding("SB204", object.where,
                                          fmt::format("polygon {} at ({:.3f}, {:.3f}, {:.3f}) has no area; left out.",
                                                      surface.source_index, p.x, p.y, p.z)));
                clean.ring_first.resize(ring_begin + 1);
                clean.corners.resize(clean.ring_first.back());
                if (!g.corner_uv.empty()) clean.corner_uv.resize(clean.corners.size());
                continue;
            }
            surface.ring_begin = ring_begin;
            surface.ring_end = static_cast<std::uint32_t>(clean.ring_first.size() - 1);
            clean.surfaces.push_back(surface);
        }
        shell.surface_end = static_cast<std::uint32_t>(clean.surfaces.size());
        if (shell.surface_end > shell.surface_begin) clean.shells.push_back(shell);
    }
    if (cleaned > 0) {
        findings.add(
            make_finding("SB205", object.where,
                         fmt::format("{} rings had repeated corners or spikes, which were taken out.", cleaned)));
    }
    g = std::move(clean);
}

void drop_repeated_surfaces(CityObject& object, FindingLog& findings) {
    Geometry& g = object.geometry;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    keys.reserve(g.surfaces.size());
    for (std::uint32_t i = 0; i < g.surfaces.size(); ++i) keys.emplace_back(surface_key(g, g.surfaces[i]), i);
    std::sort(keys.begin(), keys.end());
    std::vector<char> keep(g.surfaces.size(), 1);
    std::size_t dropped = 0;
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (keys[i].first != keys[i - 1].first) continue;
        // Solids that touch share a wall, once from each side: only the same side twice is a repetition.
        const Vec3d a = surface_area_vector(g, g.surfaces[keys[i - 1].second]);
        const Vec3d b = surface_area_vector(g, g.surfaces[keys[i].second]);
        if (glm::dot(a, b) <= 0.0) continue;
        Surface& first = g.surfaces[keys[i - 1].second];
        if (first.type == SurfaceType::unknown) first.type = g.surfaces[keys[i].second].type;
        keep[keys[i].second] = 0;
        keys[i].second = keys[i - 1].second;
        ++dropped;
    }
    if (dropped == 0) return;
    findings.add(
        make_finding("SB202", object.where,
                     fmt::format("{} of {} surfaces are there twice; each is used once.", dropped, g.surfaces.size())));
    keep_surfaces(g, keep);
}

}  // namespace skybake::repair_steps
