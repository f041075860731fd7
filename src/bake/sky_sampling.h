// The ways to find which texels see which part of the sky.
#pragma once

#include <array>
#include <string_view>

namespace skybake {

enum class SkySampling {
    projected,     // the shadows of everything on each tile, direction by direction: exact, next to no rays
    hierarchical,  // rays from some texels, the others by halving cells (paper §4.2)
    full           // a ray from every texel
};

/// In the order of SkySampling, as options and the manifest spell them.
inline constexpr std::array<std::string_view, 3> kSkySamplingNames{"projected", "hierarchical", "full"};

}  // namespace skybake
