// Rectangles into pages.
#pragma once

#include <span>
#include <vector>

#include "atlas/atlas.h"

namespace skybake {

/// Places every chart with its gutter on a page of at most kMaxPageSize², in blocks of 4 × 4 texels that belong to one
/// chart (so that two mip levels do not mix charts), and returns the pages. Charts that follow each other share a page
/// where they can. Deterministic.
std::vector<AtlasPage> pack_charts(std::span<Chart> charts);

}  // namespace skybake
