#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "city/finding_codes.h"
#include "city/polygon.h"
#include "city/repair_outside.h"
#include "city/repair_steps.h"

namespace skybake::repair_steps {
namespace {

/// Below this share of what it could be, a shell's volume about its middle says nothing of inside and outside.
/// Empirical: boxes without floor reach 0.8, single walls 0.
constexpr double kClearVolume = 0.2;

/// A piece of a loose set is turned when more than this share of its area votes for it. Empirical: with it, walls of
/// Ingolstadt's street stay as they are filed but for slivers, and windows that face inward go from 158 to 51 m²
/// (docs/validation.md).
constexpr double kClearVote = 0.2;
/// Surfaces of one piece that are asked, and ray-triangle tests for one shell (half a second at most).
constexpr std::size_t kMostAsked = 64;
constexpr std::size_t kMostRays = 20'000'000;

/// One use of an edge: by a surface, along (lo, hi) or against it.
struct EdgeUse {
    std::uint32_t lo, hi, surface;
    bool is_along;
    bool same_edge(const EdgeUse& other) const { return lo == other.lo && hi == other.hi; }
};

struct Link {
    std::uint32_t other;
    bool is_consistent;  // both run the edge in opposite senses
};

struct ShellTopology {
    std::vector<std::uint32_t> link_first;  // one more than surfaces
    std::vector<Link> links;
    std::size_t open_edges = 0;
    std::size_t crowded_edges = 0;  // of more than two surfaces
    Vec3d open_place{0.0};
};

ShellTopology topology_of(const Geometry& g, const Shell& shell) {
    std::vector<EdgeUse> uses;
    for (std::uint32_t s = shell.surface_begin; s < shell.surface_end; ++s) {
        for (std::uint32_t r = g.surfaces[s].ring_begin; r < g.surfaces[s].ring_end; ++r) {
            const auto ring = ring_of(g, r);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const std::uint32_t a = ring[i];
                const std::uint32_t b = ring[(i + 1) % ring.size()];
                uses.push_back({std::min(a, b), std::max(a, b), s - shell.surface_begin, a < b});
            }
        }
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.lo, a.hi, a.surface, a.is_along) < std::tie(b.lo, b.hi, b.surface, b.is_along);
    });
    ShellTopology topology;
    std::vector<std::pair<std::uint32_t, Link>> pairs;
    for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
        for (end = i; end < uses.size() && uses[end].same_edge(uses[i]);) ++end;
        if (end - i == 1 && topology.open_edges++ == 0) topology.open_place = g.vertices[uses[i].lo];
        if (end - i > 2) ++topology.crowded_edges;
        if (end - i != 2 || uses[i].surface == uses[i + 1].surface) continue;
        const bool is_consistent = uses[i].is_along != uses[i + 1].is_along;
        pairs.emplace_back(uses[i].surface, Link{uses[i + 1].surface, is_consistent});
        pairs.emplace_back(uses[i + 1].surface, Link{uses[i].surface, is_consistent});
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const std::uint32_t count = shell.surface_end - shell.surface_begin;
    topology.link_first.assign(count + 1, 0);
    for (const auto& [from, link] : pairs) {
        ++topology.link_first[from + 1];
        topology.links.push_back(link);
    }
    for (std::uint32_t i = 0; i < count; ++i) topology.link_first[i + 1] += topology.link_first[i];
    return topology;
}

struct SurfaceVector {
    Vec3d area{0.0};
    Vec3d center{0.0};
};

SurfaceVector vector_of(const Geometry& g, const Surface& surface) {
    SurfaceVector v{surface_area_vector(g, surface), Vec3d(0.0)};
    const auto ring = ring_of(g, surface.ring_begin);
    const Vec3d first = g.vertices[ring[0]];
    for (const std::uint32_t corner : ring) v.center += g.vertices[corner] - first;
    v.center = first + v.center / static_cast<double>(ring.size());
    return v;
}

/// 1 for what faces up, -1 for what faces down, 0 for the rest.
double up_vote(SurfaceType type) {
    if (type == SurfaceType::roof || type == SurfaceType::terrain || type == SurfaceType::floor) return 1.0;
    return type == SurfaceType::ground || type == SurfaceType::ceiling ? -1.0 : 0.0;
}

/// Positive when the surfaces, turned as `is_turned` says, face as they should: by the volume about their middle; where
/// that says nothing, by roofs that face up and undersides that face down; else by how the file has most of their area.
double outwardness(const Geometry& g, const Shell& shell, const std::vector<std::uint32_t>& members,
                   const std::vector<char>& is_turned) {
    const double wanted = shell.kind == Shell::Kind::inner ? -1.0 : 1.0;  // a cavity's walls face into it
    std::vector<SurfaceVector> vectors;
    Vec3d middle(0.0);
    double total = 0.0;
    for (const std::uint32_t m : members) {
        vectors.push_back(vector_of(g, g.surfaces[shell.surface_begin + m]));
        if (is_turned[m]) vectors.back().area = -vectors.back().area;
        const double area = glm::length(vectors.back().area);
        middle += area * (vectors.back().center - vectors.front().center);
        total += area;
    }
    middle = vectors.front().center + (total > 0.0 ? middle / total : Vec3d(0.0));
    double volume = 0.0, possible = 0.0, vote = 0.0, as_filed = 0.0;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const SurfaceVector& v = vectors[i];
        volume += glm::dot(v.area, v.center - middle);
        possible += glm::length(v.area) * glm::length(v.center - middle);
        vote += up_vote(g.surfaces[shell.surface_begin + members[i]].type) * v.area.z;
        as_filed += (is_turned[members[i]] ? -1.0 : 1.0) * glm::length(v.area);
    }
    if (members.size() >= 3 && std::abs(volume) > kClearVolume * possible) return wanted * volume;
    if (std::abs(vote) > 1e-3 * total) return wanted * vote;
    return as_filed;
}

/// Turns pieces of a loose set that face the body's inside; returns how many surfaces were turned. A piece is what the
/// file has run alike: neighbours that disagree may both be right where a surface between them is missing, so they do
/// not overrule the file; rays that leave the piece do. Where rays do not tell, roofs that face down and undersides
/// that face up do.
std::size_t orient_loose(Geometry& g, const Shell& shell, const ShellTopology& topology, const OutsideTest& outside) {
    const std::uint32_t count = shell.surface_end - shell.surface_begin;
    std::vector<char> is_seen(count, 0);
    std::vector<std::uint32_t> members;
    std::size_t turned = 0, rays = 0;
    for (std::uint32_t root = 0; root < count; ++root) {
        if (is_seen[root]) continue;
        members.assign(1, root);
        is_seen[root] = 1;
        for (std::size_t at = 0; at < members.size(); ++at) {
            for (std::uint32_t l = topology.link_first[members[at]]; l < topology.link_first[members[at] + 1]; ++l) {
                const Link& link = topology.links[l];
                if (is_seen[link.other] || !link.is_consistent) continue;
                is_seen[link.other] = 1;
                members.push_back(link.other);
            }
        }
        double total = 0.0, by_rays = 0.0, by_type = 0.0;
        // Large pieces are asked at some of their surfaces, evenly spread.
        const std::size_t step = (members.size() + kMostAsked - 1) / kMostAsked;
        for (std::size_t i = 0; i < members.size(); i += step) {
            const Surface& surface = g.surfaces[shell.surface_begin + members[i]];
            const Vec3d area = surface_area_vector(g, surface);
            total += glm::length(area);
            by_type += up_vote(surface.type) * area.z;
            if (rays++ < kMostRays / std::max<std::size_t>(outside.triangle_count(), 1))
                by_rays += glm::length(area) * outside.side_of(shell.surface_begin + members[i]);
        }
        const double vote = std::abs(by_rays) > kClearVote * total ? by_rays : by_type;
        if (vote >= -kClearVote * total) continue;
        for (const std::uint32_t m : members) turn(g, g.surfaces[shell.surface_begin + m]);
        turned += members.size();
    }
    return turned;
}

/// Turns the surfaces of a solid's shell so that neighbours agree and each connected piece faces outward; returns how
/// many were turned.
std::size_t orient_shell(Geometry& g, const Shell& shell, const ShellTopology& topology) {
    const std::uint32_t count = shell.surface_end - shell.surface_begin;
    std::vector<char> is_turned(count, 0), is_seen(count, 0);
    std::vector<std::uint32_t> members;
    std::size_t turned = 0;
    for (std::uint32_t root = 0; root < count; ++root) {
        if (is_seen[root]) continue;
        members.assign(1, root);
        is_seen[root] = 1;
        for (std::size_t at = 0; at < members.size(); ++at) {
            const std::uint32_t m = members[at];
            for (std::uint32_t l = topology.link_first[m]; l < topology.link_first[m + 1]; ++l) {
                const Link& link = topology.links[l];
                if (is_seen[link.other]) continue;
                is_seen[link.other] = 1;
                is_turned[link.other] = static_cast<char>(link.is_consistent ? is_turned[m] : !is_turned[m]);
                members.push_back(link.other);
            }
        }
        const bool is_inside_out = outwardness(g, shell, members, is_turned) < 0.0;
        for (const std::uint32_t m : members) {
            if ((is_turned[m] != 0) == is_inside_out) continue;
            turn(g, g.surfaces[shell.surface_begin + m]);
            ++turned;
        }
    }
    return turned;
}

}  // namespace

void turn(Geometry& geometry, const Surface& surface) {
    for (std::uint32_t r = surface.ring_begin; r < surface.ring_end; ++r) {
        const auto begin = static_cast<std::ptrdiff_t>(geometry.ring_first[r]);
        const auto end = static_cast<std::ptrdiff_t>(geometry.ring_first[r + 1]);
        std::reverse(geometry.corners.begin() + begin, geometry.corners.begin() + end);
        if (!geometry.corner_uv.empty())
            std::reverse(geometry.corner_uv.begin() + begin, geometry.corner_uv.begin() + end);
    }
}

ShellCounts orient(CityObject& object, FindingLog& findings) {
    Geometry& g = object.geometry;
    ShellCounts counts;
    std::size_t turned = 0;
    if (is_ground(object.type)) {  // seen from above, whatever its shells
        for (const Surface& surface : g.surfaces) {
            const Vec3d area = surface_area_vector(g, surface);
            if (area.z < -0.01 * glm::length(area)) {
                turn(g, surface);
                ++turned;
            }
        }
        if (turned > 0)
            findings.add(
                make_finding("SB207", object.where,
                             fmt::format("{} of {} surfaces faced down; turned up.", turned, g.surfaces.size())));
        return counts;
    }
    std::optional<OutsideTest> outside;
    for (const Shell& shell : g.shells) {
        const ShellTopology topology = topology_of(g, shell);
        const std::size_t count = shell.surface_end - shell.surface_begin;
        // A loose set that is closed all the same is oriented as a solid's shell.
        const bool is_body =
            shell.kind != Shell::Kind::loose || (topology.open_edges == 0 && topology.crowded_edges == 0);
        if (!is_body && !outside) outside.emplace(g);
        const std::size_t turned_here =
            is_body ? orient_shell(g, shell, topology) : orient_loose(g, shell, topology, *outside);
        if (shell.kind != Shell::Kind::loose && turned_here == count) {
            findings.add(make_finding("SB208", object.where,
                                      fmt::format("a solid of {} surfaces was inside out; turned.", count)));
        } else {
            turned += turned_here;
        }
        if (shell.kind == Shell::Kind::loose) continue;
        ++(topology.open_edges == 0 ? counts.closed : counts.open);
        if (topology.open_edges > 0) {
            const Vec3d& p = topology.open_place;
            findings.add(make_finding(
                "SB209", object.where,
                fmt::format("{} edges of a solid belong to one surface only, the first at ({:.3f}, {:.3f}, {:.3f}).",
                            topology.open_edges, p.x, p.y, p.z)));
        }
        if (topology.crowded_edges > 0) {
            findings.add(make_finding(
                "SB213", object.where,
                fmt::format("{} edges of a solid belong to more than two surfaces.", topology.crowded_edges)));
        }
    }
    if (turned > 0) {
        findings.add(make_finding("SB207", object.where,
                                  fmt::format("{} of {} surfaces faced inward; turned.", turned, g.surfaces.size())));
    }
    return counts;
}

void infer_types(CityObject& object) {
    Geometry& g = object.geometry;
    const auto by_object = [&]() -> std::optional<SurfaceType> {
        switch (object.type) {
            case ObjectType::terrain:
            case ObjectType::land_use:
                return SurfaceType::terrain;
            case ObjectType::road:
            case ObjectType::railway:
            case ObjectType::square:
                return SurfaceType::road;
            case ObjectType::water:
                return SurfaceType::water;
            case ObjectType::plant_cover:
            case ObjectType::solitary_vegetation:
                return SurfaceType::vegetation;
            case ObjectType::furniture:
                return SurfaceType::other;
            default:
                return std::nullopt;
        }
    }();
    double lowest = std::numeric_limits<double>::max();
    for (const Vec3d& p : g.vertices) lowest = std::min(lowest, p.z);
    for (Surface& surface : g.surfaces) {
        if (surface.type != SurfaceType::unknown) continue;
        if (by_object) {
            surface.type = *by_object;
            continue;
        }
        const SurfaceVector v = vector_of(g, surface);
        const double up = v.area.z / glm::length(v.area);
        // Steeper than 75° is a wall; what faces down is the underside where it stands on the ground, else a ceiling.
        constexpr double kSteep = 0.2588;
        if (up > kSteep) {
            surface.type = SurfaceType::roof;
        } else if (up < -kSteep) {
            surface.type = v.center.z < lowest + 0.5 ? SurfaceType::ground : SurfaceType::ceiling;
        } else {
            surface.type = SurfaceType::wall;
        }
    }
}

}  // namespace skybake::repair_steps
