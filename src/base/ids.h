// Distinct ids are distinct types: a mix-up of a chart with a triangle does not compile.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace skybake {

template <typename Tag>
struct Id {
    std::uint32_t value = 0;
    constexpr Id() = default;
    constexpr explicit Id(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}
    constexpr std::size_t index() const { return value; }
    friend constexpr auto operator<=>(Id, Id) = default;
};

using MaterialId = Id<struct MaterialTag>;
using TextureId = Id<struct TextureTag>;
using FaceId = Id<struct FaceTag>;
using ChartId = Id<struct ChartTag>;
using PageId = Id<struct PageTag>;

}  // namespace skybake
