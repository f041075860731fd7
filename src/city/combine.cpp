#include "city/combine.h"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "base/hash_rng.h"

namespace skybake {
namespace {

std::uint64_t position_key(const Vec3d& p) {
    // Adding zero makes -0 the same place as 0.
    const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v + 0.0); };
    return hash_combine(hash_combine(bits(p.x), bits(p.y)), bits(p.z));
}

std::uint32_t first_corner(const Geometry& g, const Surface& s) {
    return g.ring_first[s.ring_begin];
}
std::uint32_t end_corner(const Geometry& g, const Surface& s) {
    return g.ring_first[s.ring_end];
}

/// Copies the texture of `from` to `to`, corner by corner at the same place.
void copy_texture(Geometry& geometry, Surface& to, const Geometry& other, const Surface& from) {
    std::vector<std::pair<std::uint64_t, Vec2f>> uvs;
    for (std::uint32_t i = first_corner(other, from); i < end_corner(other, from); ++i) {
        uvs.emplace_back(position_key(other.vertices[other.corners[i]]), other.corner_uv[i]);
    }
    std::stable_sort(uvs.begin(), uvs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    geometry.corner_uv.resize(geometry.corners.size(), Vec2f(0.0f));
    for (std::uint32_t i = first_corner(geometry, to); i < end_corner(geometry, to); ++i) {
        const std::uint64_t key = position_key(geometry.vertices[geometry.corners[i]]);
        const auto found =
            std::lower_bound(uvs.begin(), uvs.end(), key, [](const auto& a, std::uint64_t k) { return a.first < k; });
        if (found == uvs.end() || found->first != key) return;
        geometry.corner_uv[i] = found->second;
    }
    to.texture = from.texture;
}

void append_surface(Geometry& geometry, const Geometry& other, const Surface& from, std::uint32_t first_vertex,
                    std::uint32_t source_offset) {
    Surface surface = from;
    surface.source_index += source_offset;
    surface.ring_begin = static_cast<std::uint32_t>(geometry.ring_first.size() - 1);
    for (std::uint32_t ring = from.ring_begin; ring < from.ring_end; ++ring) {
        for (std::uint32_t i = other.ring_first[ring]; i < other.ring_first[ring + 1]; ++i) {
            geometry.corners.push_back(first_vertex + other.corners[i]);
            if (!other.corner_uv.empty()) {
                geometry.corner_uv.resize(geometry.corners.size(), Vec2f(0.0f));
                geometry.corner_uv.back() = other.corner_uv[i];
            }
        }
        geometry.ring_first.push_back(static_cast<std::uint32_t>(geometry.corners.size()));
    }
    surface.ring_end = static_cast<std::uint32_t>(geometry.ring_first.size() - 1);
    geometry.surfaces.push_back(surface);
}

}  // namespace

std::uint64_t surface_key(const Geometry& geometry, const Surface& surface) {
    std::uint64_t sum = 0;  // of hashes: the same in any order
    for (std::uint32_t i = first_corner(geometry, surface); i < end_corner(geometry, surface); ++i) {
        sum += position_key(geometry.vertices[geometry.corners[i]]);
    }
    return hash_combine(sum, end_corner(geometry, surface) - first_corner(geometry, surface));
}

std::uint32_t combine(Geometry& geometry, const Geometry& other) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> known;
    known.reserve(geometry.surfaces.size());
    std::uint32_t source_offset = 0;
    for (std::uint32_t i = 0; i < geometry.surfaces.size(); ++i) {
        known.emplace_back(surface_key(geometry, geometry.surfaces[i]), i);
        source_offset = std::max(source_offset, geometry.surfaces[i].source_index + 1);
    }
    std::sort(known.begin(), known.end());
    const auto first_vertex = static_cast<std::uint32_t>(geometry.vertices.size());
    const std::size_t surfaces_before = geometry.surfaces.size();
    std::uint32_t twice = 0;
    for (const Shell& from : other.shells) {
        Shell shell = from;
        shell.surface_begin = static_cast<std::uint32_t>(geometry.surfaces.size());
        for (std::uint32_t i = from.surface_begin; i < from.surface_end; ++i) {
            const Surface& theirs = other.surfaces[i];
            const std::uint64_t key = surface_key(other, theirs);
            const auto found = std::lower_bound(known.begin(), known.end(), std::pair(key, 0u));
            if (found == known.end() || found->first != key) {
                append_surface(geometry, other, theirs, first_vertex, source_offset);
                continue;
            }
            ++twice;
            Surface& ours = geometry.surfaces[found->second];
            if (ours.type == SurfaceType::unknown) ours.type = theirs.type;
            if (!ours.material) ours.material = theirs.material;
            if (!ours.texture && theirs.texture) copy_texture(geometry, ours, other, theirs);
        }
        shell.surface_end = static_cast<std::uint32_t>(geometry.surfaces.size());
        if (shell.surface_end > shell.surface_begin) geometry.shells.push_back(shell);
    }
    if (geometry.surfaces.size() > surfaces_before) {
        geometry.vertices.insert(geometry.vertices.end(), other.vertices.begin(), other.vertices.end());
    }
    if (!geometry.corner_uv.empty()) geometry.corner_uv.resize(geometry.corners.size(), Vec2f(0.0f));
    return twice;
}

void keep_surfaces(Geometry& geometry, const std::vector<char>& keep) {
    if (std::all_of(keep.begin(), keep.end(), [](char k) { return k != 0; })) return;
    Geometry kept;
    kept.vertices = std::move(geometry.vertices);
    for (const Shell& from : geometry.shells) {
        Shell shell = from;
        shell.surface_begin = static_cast<std::uint32_t>(kept.surfaces.size());
        for (std::uint32_t i = from.surface_begin; i < from.surface_end; ++i) {
            if (keep[i]) append_surface(kept, geometry, geometry.surfaces[i], 0, 0);
        }
        shell.surface_end = static_cast<std::uint32_t>(kept.surfaces.size());
        if (shell.surface_end > shell.surface_begin) kept.shells.push_back(shell);
    }
    geometry = std::move(kept);
}

void drop_unused_vertices(Geometry& geometry) {
    constexpr std::uint32_t kUnused = 0xffffffffu;
    std::vector<std::uint32_t> renumbered(geometry.vertices.size(), kUnused);
    for (const std::uint32_t corner : geometry.corners) renumbered[corner] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < geometry.vertices.size(); ++i) {
        if (renumbered[i] == kUnused) continue;
        renumbered[i] = count;
        geometry.vertices[count++] = geometry.vertices[i];
    }
    geometry.vertices.resize(count);
    for (std::uint32_t& corner : geometry.corners) corner = renumbered[corner];
}

}  // namespace skybake
