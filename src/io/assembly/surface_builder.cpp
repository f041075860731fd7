#include "io/assembly/surface_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "city/finding_codes.h"

namespace skybake::io {

void SurfaceBuilder::begin_shell(Shell::Kind kind) {
    Shell shell;
    shell.kind = kind;
    shell.surface_begin = static_cast<std::uint32_t>(geometry.surfaces.size());
    geometry.shells.push_back(shell);
}

void SurfaceBuilder::end_shell() {
    Shell& shell = geometry.shells.back();
    shell.surface_end = static_cast<std::uint32_t>(geometry.surfaces.size());
    if (shell.surface_end == shell.surface_begin) geometry.shells.pop_back();
}

void SurfaceBuilder::begin_surface() {
    first_ring_ = geometry.ring_first.size();
    first_corner_ = geometry.corners.size();
}

std::size_t SurfaceBuilder::close_ring() {
    std::vector<std::uint32_t>& corners = geometry.corners;
    const std::size_t first = geometry.ring_first.back();
    while (corners.size() > first + 1 && corners.back() == corners[first]) corners.pop_back();
    const std::size_t count = corners.size() - first;
    if (count < 3) {
        corners.resize(first);
    } else {
        geometry.ring_first.push_back(static_cast<std::uint32_t>(corners.size()));
    }
    return count;
}

void SurfaceBuilder::drop_surface() {
    geometry.corners.resize(first_corner_);
    geometry.ring_first.resize(first_ring_);
}

Surface& SurfaceBuilder::end_surface(std::uint32_t source_index) {
    Surface surface;
    surface.ring_begin = static_cast<std::uint32_t>(first_ring_ - 1);
    surface.ring_end = static_cast<std::uint32_t>(geometry.ring_first.size() - 1);
    surface.source_index = source_index;
    geometry.surfaces.push_back(surface);
    return geometry.surfaces.back();
}

void SurfaceBuilder::set_texture(TextureId texture, std::span<const Vec2f> uvs) {
    geometry.surfaces.back().texture = texture;
    uvs_.resize(first_corner_, Vec2f(0.0f));
    uvs_.insert(uvs_.end(), uvs.begin(), uvs.end());
}

void SurfaceBuilder::reverse_surface() {
    const Surface& surface = geometry.surfaces.back();
    for (std::uint32_t r = surface.ring_begin; r < surface.ring_end; ++r) {
        const auto begin = static_cast<std::ptrdiff_t>(geometry.ring_first[r]);
        const auto end = static_cast<std::ptrdiff_t>(geometry.ring_first[r + 1]);
        std::reverse(geometry.corners.begin() + begin, geometry.corners.begin() + end);
        if (surface.texture) std::reverse(uvs_.begin() + begin, uvs_.begin() + end);
    }
}

Geometry SurfaceBuilder::finish() {
    if (!uvs_.empty()) {
        uvs_.resize(geometry.corners.size(), Vec2f(0.0f));
        geometry.corner_uv = std::move(uvs_);
    }
    Geometry result = std::move(geometry);
    *this = SurfaceBuilder();
    return result;
}

Finding short_ring(std::string where, bool is_outer, std::size_t corners) {
    return make_finding("SB204", std::move(where),
                        fmt::format("{} has {} corners; left out.", is_outer ? "outer ring" : "hole", corners));
}

}  // namespace skybake::io
