// Compiled once for each instruction set; the best that the processor has is taken at run time. All do the same
// operations in the same order, without fused multiply-add: the same bits everywhere.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/shadow_projection.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "bake/shadow_projection.h"
#include "bake/sky_tile.h"
#include "base/box.h"
#include "base/check.h"
#include "trace/occluder_tree.h"

HWY_BEFORE_NAMESPACE();
namespace skybake {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kWidth = OccluderTree::kWidth;
using Lanes16 = hn::CappedTag<float, kWidth>;
using V = hn::Vec<Lanes16>;

/// Bit i: lane i of the mask.
template <class M>
HWY_INLINE std::uint32_t bits_of(Lanes16 tag, M mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(tag, mask, bytes);
    return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8;
}

/// a · p + c for the lanes of p.
HWY_INLINE V linear(Lanes16 tag, const Vec3f& a, float c, V x, V y, V z) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(tag, a.x), x), hn::Mul(hn::Set(tag, a.y), y)),
                   hn::Add(hn::Mul(hn::Set(tag, a.z), z), hn::Set(tag, c)));
}

/// What the tile's points cover, projected along any direction of the range.
struct Window {
    Vec2f lo, hi;
};

/// Which of a node's children may shade the tile.
HWY_INLINE std::uint32_t overlapping(const ProjectionTile& tile, const OccluderTree::Node& node,
                                     const SlopeRange& range, const Window& window, std::size_t lane) {
    const Lanes16 tag;
    const auto x = hn::Load(tag, node.center[0] + lane), y = hn::Load(tag, node.center[1] + lane),
               z = hn::Load(tag, node.center[2] + lane);
    const auto ex = hn::Load(tag, node.extent[0] + lane), ey = hn::Load(tag, node.extent[1] + lane),
               ez = hn::Load(tag, node.extent[2] + lane);
    const auto zero = hn::Zero(tag);
    const Vec3f n = tile.axis_h;
    const auto top =
        hn::Add(linear(tag, n, -glm::dot(n, tile.origin), x, y, z), linear(tag, glm::abs(n), 0.0f, ex, ey, ez));
    auto mask = hn::Gt(top, hn::Zero(tag));
    const auto reach = hn::Max(top, zero);
    const auto test = [&](const Vec3f& axis, float mean, float spread, float lo, float hi) {
        const Vec3f a = axis - mean * n;
        const auto center = linear(tag, a, -glm::dot(a, tile.origin), x, y, z);
        const auto extent = hn::Add(linear(tag, glm::abs(a), 1e-3f, ex, ey, ez), hn::Mul(hn::Set(tag, spread), reach));
        mask = hn::And(mask, hn::And(hn::Le(hn::Sub(center, extent), hn::Set(tag, hi)),
                                     hn::Ge(hn::Add(center, extent), hn::Set(tag, lo))));
    };
    test(tile.axis_u, range.mean.x, range.spread.x, window.lo.x, window.hi.x);
    test(tile.axis_v, range.mean.y, range.spread.y, window.lo.y, window.hi.y);
    return bits_of(tag, mask);
}

/// Appends the leaf's quads that may shade the tile.
HWY_INLINE void append_overlapping(ProjectionTile& tile, const OccluderTree::Leaf& leaf, const SlopeRange& range,
                                   const Window& window, std::size_t lane) {
    const Lanes16 tag;
    V u[4], v[4], h[4];
    V lo_u, hi_u, lo_v, hi_v, top;
    for (int k = 0; k < 4; ++k) {
        const V x = hn::Sub(hn::Load(tag, leaf.corner[k][0] + lane), hn::Set(tag, tile.origin.x)),
                y = hn::Sub(hn::Load(tag, leaf.corner[k][1] + lane), hn::Set(tag, tile.origin.y)),
                z = hn::Sub(hn::Load(tag, leaf.corner[k][2] + lane), hn::Set(tag, tile.origin.z));
        u[k] = linear(tag, tile.axis_u, 0.0f, x, y, z);
        v[k] = linear(tag, tile.axis_v, 0.0f, x, y, z);
        h[k] = linear(tag, tile.axis_h, 0.0f, x, y, z);
        const V pu = hn::Sub(u[k], hn::Mul(h[k], hn::Set(tag, range.mean.x))),
                pv = hn::Sub(v[k], hn::Mul(h[k], hn::Set(tag, range.mean.y)));
        lo_u = k == 0 ? pu : hn::Min(lo_u, pu);
        hi_u = k == 0 ? pu : hn::Max(hi_u, pu);
        lo_v = k == 0 ? pv : hn::Min(lo_v, pv);
        hi_v = k == 0 ? pv : hn::Max(hi_v, pv);
        top = k == 0 ? h[k] : hn::Max(top, h[k]);
    }
    const V slack_u = hn::Mul(hn::Set(tag, range.spread.x), top), slack_v = hn::Mul(hn::Set(tag, range.spread.y), top);
    auto mask = hn::Gt(top, hn::Zero(tag));
    mask = hn::And(mask, hn::And(hn::Le(hn::Sub(lo_u, slack_u), hn::Set(tag, window.hi.x)),
                                 hn::Ge(hn::Add(hi_u, slack_u), hn::Set(tag, window.lo.x))));
    mask = hn::And(mask, hn::And(hn::Le(hn::Sub(lo_v, slack_v), hn::Set(tag, window.hi.y)),
                                 hn::Ge(hn::Add(hi_v, slack_v), hn::Set(tag, window.lo.y))));
    if (hn::AllFalse(tag, mask)) return;
    ProjectionTile::Quads& quads = tile.candidates;
    const std::size_t at = quads.count;
    if (quads.corner[0].size() < at + 2 * kWidth) {
        for (std::vector<float>& array : quads.corner) array.resize(2 * at + 4 * kWidth);
    }
    for (std::size_t k = 0; k < 4; ++k) {
        hn::CompressStore(u[k], mask, tag, quads.corner[3 * k].data() + at);
        hn::CompressStore(v[k], mask, tag, quads.corner[3 * k + 1].data() + at);
        hn::CompressStore(h[k], mask, tag, quads.corner[3 * k + 2].data() + at);
    }
    quads.count += hn::CountTrue(tag, mask);
}

void FindCandidates(ProjectionTile& tile, const OccluderTree& tree, const SlopeRange& range) {
    const Lanes16 tag;
    const std::size_t step = hn::Lanes(tag);
    const Vec2f shift = tile.relief * (glm::abs(range.mean) + range.spread);
    const Window window{tile.lo - shift, tile.hi + shift};
    tile.candidates.count = 0;
    tile.stack.assign(1, tree.root());
    while (!tile.stack.empty()) {
        const std::uint32_t at = tile.stack.back();
        tile.stack.pop_back();
        if (at & OccluderTree::kLeaf) {
            const OccluderTree::Leaf& leaf = tree.leaves()[at & ~OccluderTree::kLeaf];
            for (std::size_t lane = 0; lane < kWidth; lane += step) append_overlapping(tile, leaf, range, window, lane);
        } else {
            const OccluderTree::Node& node = tree.nodes()[at];
            for (std::size_t lane = 0; lane < kWidth; lane += step) {
                for (std::uint32_t hit = overlapping(tile, node, range, window, lane); hit; hit &= hit - 1)
                    tile.stack.push_back(node.child[lane + static_cast<std::size_t>(std::countr_zero(hit))]);
            }
        }
    }
    // The last block is read whole.
    const std::size_t count = tile.candidates.count;
    for (std::vector<float>& array : tile.candidates.corner) {
        if (array.size() < count + kWidth) array.resize(count + kWidth);
        std::fill_n(array.begin() + static_cast<std::ptrdiff_t>(count), kWidth,
                    std::numeric_limits<float>::quiet_NaN());
    }
}

/// Up to 16 quads projected along one direction. A quad's shadow is where a u + b v + c ≥ 0 for its four edges, and,
/// when part of it lies below some point (bit of is_cut), where it is above the point: a₄ u + b₄ v + c₄ > scale × h.
struct alignas(64) Shadows {
    static constexpr int kPlanes = 5;
    float a[kPlanes][kWidth], b[kPlanes][kWidth], c[kPlanes][kWidth], scale[kWidth];
    float lo_v[kWidth], hi_v[kWidth];
    std::uint32_t is_cut = 0;
};

/// The same half planes as bounds of u in a row of a facet: u ≥ from_slope v + from, u ≤ to_slope v + to.
struct alignas(64) RowBounds {
    float from_slope[Shadows::kPlanes][kWidth], from[Shadows::kPlanes][kWidth], to_slope[Shadows::kPlanes][kWidth],
        to[Shadows::kPlanes][kWidth];
    std::uint32_t crosses[Shadows::kPlanes] = {};  // bit of a quad: the plane leaves out part of the facet
};

HWY_INLINE void set_row_bounds(RowBounds& bounds, std::size_t plane, V a, V b, V c) {
    const Lanes16 tag;
    constexpr float kFar = 1e6f;  // texels: beyond every tile
    // An edge along a row bounds v: as a line that is all but parallel to the row.
    const V flat = hn::Max(hn::Mul(hn::Abs(b), hn::Set(tag, 1e-6f)), hn::Set(tag, 1e-30f));
    a = hn::IfThenElse(hn::Lt(hn::Abs(a), flat), flat, a);
    const V scale = hn::Div(hn::Set(tag, -1.0f), a), slope = hn::Mul(b, scale), offset = hn::Mul(c, scale);
    const auto is_from = hn::Gt(a, hn::Zero(tag));
    hn::Store(hn::IfThenElseZero(is_from, slope), tag, bounds.from_slope[plane]);
    hn::Store(hn::IfThenElse(is_from, offset, hn::Set(tag, -kFar)), tag, bounds.from[plane]);
    hn::Store(hn::IfThenZeroElse(is_from, slope), tag, bounds.to_slope[plane]);
    hn::Store(hn::IfThenElse(is_from, hn::Set(tag, kFar), offset), tag, bounds.to[plane]);
}

/// Takes the shadow of quad `lane` from a facet's rows.
HWY_INLINE void cast_on_rows(std::uint64_t* open, const RowBounds& bounds, std::size_t lane, int row_begin,
                             int row_end) {
    const Lanes16 tag;
    const hn::Rebind<std::int32_t, Lanes16> tag32;
    const hn::RebindToUnsigned<decltype(tag32)> tag32u;
    const hn::Half<decltype(tag32u)> half32;
    const hn::Rebind<std::uint64_t, decltype(half32)> tag64;
    const int step = static_cast<int>(hn::Lanes(tag));
    const V first = hn::Iota(tag, 0.5f), half = hn::Set(tag, 0.5f);
    const V last = hn::Set(tag, static_cast<float>(ProjectionTile::kMaxSize));
    const auto one = hn::Set(tag64, 1);
    for (int row = row_begin; row < row_end; row += step) {
        const V v = hn::Add(first, hn::Set(tag, static_cast<float>(row)));
        V from = hn::Zero(tag), to = last;
        for (std::size_t k = 0; k < Shadows::kPlanes; ++k) {
            if (!(bounds.crosses[k] >> lane & 1)) continue;
            from = hn::Max(from, hn::Add(hn::Mul(hn::Set(tag, bounds.from_slope[k][lane]), v),
                                         hn::Set(tag, bounds.from[k][lane])));
            to = hn::Min(to,
                         hn::Add(hn::Mul(hn::Set(tag, bounds.to_slope[k][lane]), v), hn::Set(tag, bounds.to[k][lane])));
        }
        // Centres c + 0.5 in [from, to]: columns from ⌈from − 0.5⌉ to ⌊to − 0.5⌋.
        const V begin = hn::Min(hn::Ceil(hn::Sub(from, half)), last);
        const V end = hn::Max(hn::Floor(hn::Add(to, half)), begin);
        alignas(64) std::uint32_t begins[kWidth], ends[kWidth];
        hn::Store(hn::BitCast(tag32u, hn::ConvertTo(tag32, begin)), tag32u, begins);
        hn::Store(hn::BitCast(tag32u, hn::ConvertTo(tag32, end)), tag32u, ends);
        for (int i = 0; i < step; i += static_cast<int>(hn::Lanes(tag64))) {
            const auto shade = hn::Sub(hn::Shl(one, hn::PromoteTo(tag64, hn::Load(half32, ends + i))),
                                       hn::Shl(one, hn::PromoteTo(tag64, hn::Load(half32, begins + i))));
            hn::StoreU(hn::AndNot(shade, hn::LoadU(tag64, open + row + i)), tag64, open + row + i);
        }
    }
}

/// Takes the shadows of the quads in `hit` from a facet. `margin`: how far a point's v may lie from its projection.
HWY_INLINE void cast_on_facet(ProjectionTile::Facet& facet, const Shadows& shadows, std::uint32_t hit, Vec2f slope,
                              float margin) {
    const Lanes16 tag;
    RowBounds bounds;
    const V zero = hn::Zero(tag);
    const std::size_t planes = shadows.is_cut ? 5 : 4;
    const V hu = hn::Set(tag, facet.slope.x), hv = hn::Set(tag, facet.slope.y), h0 = hn::Set(tag, facet.offset);
    for (std::size_t k = 0; k < planes; ++k) {
        // In the facet's own u and v: its point (u, v, h) is projected to (u, v) − h × slope.
        V a = hn::Load(tag, shadows.a[k]), b = hn::Load(tag, shadows.b[k]), c = hn::Load(tag, shadows.c[k]);
        V g = hn::Add(hn::Mul(a, hn::Set(tag, slope.x)), hn::Mul(b, hn::Set(tag, slope.y)));
        if (k == 4) g = hn::Add(g, hn::Load(tag, shadows.scale));
        a = hn::Sub(a, hn::Mul(g, hu));
        b = hn::Sub(b, hn::Mul(g, hv));
        c = hn::Sub(c, hn::Mul(g, h0));
        const V a_lo = hn::Mul(a, hn::Set(tag, facet.lo.x)), a_hi = hn::Mul(a, hn::Set(tag, facet.hi.x)),
                b_lo = hn::Mul(b, hn::Set(tag, facet.lo.y)), b_hi = hn::Mul(b, hn::Set(tag, facet.hi.y));
        const V highest = hn::Add(hn::Add(hn::Max(a_lo, a_hi), hn::Max(b_lo, b_hi)), c),
                lowest = hn::Add(hn::Add(hn::Min(a_lo, a_hi), hn::Min(b_lo, b_hi)), c);
        const std::uint32_t applies = k == 4 ? shadows.is_cut : ~0u;
        hit &= bits_of(tag, hn::Ge(highest, zero)) | ~applies;
        bounds.crosses[k] = bits_of(tag, hn::Lt(lowest, zero)) & applies;
        set_row_bounds(bounds, k, a, b, c);
    }
    if (!hit) return;
    for (; hit; hit &= hit - 1) {
        const std::size_t lane = static_cast<std::size_t>(std::countr_zero(hit));
        const float lo = std::max(shadows.lo_v[lane] - margin, static_cast<float>(facet.row_begin));
        const float hi = std::min(shadows.hi_v[lane] + margin, static_cast<float>(facet.row_end) - 0.5f);
        if (!(lo <= hi)) continue;
        cast_on_rows(facet.open.data(), bounds, lane, static_cast<int>(lo), static_cast<int>(hi) + 1);
    }
    std::uint64_t left = 0;
    for (int row = facet.row_begin; row < facet.row_end; ++row) left |= facet.open[static_cast<std::size_t>(row)];
    facet.is_dark = left == 0;
}

/// Takes the shadow of quad `lane` from the loose points.
HWY_INLINE void cast_on_points(ProjectionTile& tile, const Shadows& shadows, std::size_t lane, int row_begin,
                               int row_end, const float* points_u, const float* points_v) {
    const Lanes16 tag;
    const std::size_t step = hn::Lanes(tag);
    const bool is_cut = shadows.is_cut >> lane & 1;
    const V zero = hn::Zero(tag);
    const std::uint32_t end = tile.end_row[static_cast<std::size_t>(row_end - 1)];
    for (std::uint32_t block = tile.first_row[static_cast<std::size_t>(row_begin)]; block < end; ++block) {
        if (!tile.open_block[block]) continue;
        std::uint32_t shade = 0;
        for (std::size_t i = 0; i < kWidth; i += step) {
            const std::size_t at = block * kWidth + i;
            const V u = hn::LoadU(tag, points_u + at), v = hn::LoadU(tag, points_v + at);
            const auto plane = [&](int k) {
                return hn::Add(
                    hn::Add(hn::Mul(hn::Set(tag, shadows.a[k][lane]), u), hn::Mul(hn::Set(tag, shadows.b[k][lane]), v)),
                    hn::Set(tag, shadows.c[k][lane]));
            };
            const V inside = hn::Min(hn::Min(plane(0), plane(1)), hn::Min(plane(2), plane(3)));
            auto mask = hn::Ge(inside, zero);
            if (is_cut) {
                mask = hn::And(mask, hn::Gt(plane(4), hn::Mul(hn::Set(tag, shadows.scale[lane]),
                                                              hn::LoadU(tag, tile.h.data() + at))));
            }
            shade |= bits_of(tag, mask) << i;
        }
        tile.open_block[block] &= ~shade;
    }
}

/// Takes the quads' shadows along the direction of the given slopes from what is open of the tile, and notes in
/// tile.hits which quads shade how much of it. True when nothing is left open.
bool CastShadows(ProjectionTile& tile, const ProjectionTile::Quads& quads, Vec2f slope) {
    const Lanes16 tag;
    const std::size_t step = hn::Lanes(tag);
    const std::size_t blocks = tile.in_use.size();
    const float *points_u = tile.u.data(), *points_v = tile.v.data();
    Vec2f lo = tile.lo, hi = tile.hi;
    const Vec2f shift = tile.relief * slope;  // of the highest point against the lowest
    if (tile.relief > 0.0f) {
        for (std::size_t i = 0; i < blocks * kWidth; i += step) {
            const V h = hn::LoadU(tag, tile.h.data() + i);
            hn::StoreU(hn::Sub(hn::LoadU(tag, tile.u.data() + i), hn::Mul(h, hn::Set(tag, slope.x))), tag,
                       tile.projected_u.data() + i);
            hn::StoreU(hn::Sub(hn::LoadU(tag, tile.v.data() + i), hn::Mul(h, hn::Set(tag, slope.y))), tag,
                       tile.projected_v.data() + i);
        }
        points_u = tile.projected_u.data();
        points_v = tile.projected_v.data();
        lo -= glm::max(shift, Vec2f(0.0f));
        hi -= glm::min(shift, Vec2f(0.0f));
    }
    // A point's projection lies so far from its row at most: points lie within their texels but for rounding.
    const float margin = 0.01f + std::abs(shift.y);
    const auto row_of = [&](float v) {
        return static_cast<int>(std::min(std::max(v, 0.0f), static_cast<float>(tile.height - 1)));
    };
    const V slope_u = hn::Set(tag, slope.x), slope_v = hn::Set(tag, slope.y), zero = hn::Zero(tag);
    for (std::size_t begin = 0; begin < quads.count; begin += step) {
        V u[4], v[4], h[4];
        V lo_u, hi_u, lo_v, hi_v, bottom;
        for (std::size_t k = 0; k < 4; ++k) {
            h[k] = hn::LoadU(tag, quads.corner[3 * k + 2].data() + begin);
            u[k] = hn::Sub(hn::LoadU(tag, quads.corner[3 * k].data() + begin), hn::Mul(h[k], slope_u));
            v[k] = hn::Sub(hn::LoadU(tag, quads.corner[3 * k + 1].data() + begin), hn::Mul(h[k], slope_v));
            lo_u = k == 0 ? u[k] : hn::Min(lo_u, u[k]);
            hi_u = k == 0 ? u[k] : hn::Max(hi_u, u[k]);
            lo_v = k == 0 ? v[k] : hn::Min(lo_v, v[k]);
            hi_v = k == 0 ? v[k] : hn::Max(hi_v, v[k]);
            bottom = k == 0 ? h[k] : hn::Min(bottom, h[k]);
        }
        auto mask = hn::And(hn::And(hn::Le(lo_u, hn::Set(tag, hi.x)), hn::Ge(hi_u, hn::Set(tag, lo.x))),
                            hn::And(hn::Le(lo_v, hn::Set(tag, hi.y)), hn::Ge(hi_v, hn::Set(tag, lo.y))));
        if (hn::AllFalse(tag, mask)) continue;

        // Twice the area, from the diagonals.
        const V du1 = hn::Sub(u[2], u[0]), dv1 = hn::Sub(v[2], v[0]), du2 = hn::Sub(u[3], u[1]),
                dv2 = hn::Sub(v[3], v[1]);
        const V area = hn::Sub(hn::Mul(du1, dv2), hn::Mul(du2, dv1));
        const V sign = hn::CopySign(hn::Set(tag, 1.0f), area);
        mask = hn::And(mask, hn::Ne(area, zero));  // else seen edge-on
        Shadows shadows;
        auto is_whole = mask;
        V a[Shadows::kPlanes], b[Shadows::kPlanes], c[Shadows::kPlanes];
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t next = (k + 1) % 4;
            a[k] = hn::Mul(sign, hn::Sub(v[k], v[next]));
            b[k] = hn::Mul(sign, hn::Sub(u[next], u[k]));
            // The corners' rounding moves the edge by so much at most.
            const V one = hn::Set(tag, 1.0f);
            const V rounding = hn::Add(hn::Mul(hn::Abs(a[k]), hn::Add(hn::Add(hn::Abs(u[k]), hn::Abs(u[next])), one)),
                                       hn::Mul(hn::Abs(b[k]), hn::Add(hn::Add(hn::Abs(v[k]), hn::Abs(v[next])), one)));
            c[k] =
                hn::Sub(hn::Mul(hn::Set(tag, 0x1p-21f), rounding), hn::Add(hn::Mul(a[k], u[k]), hn::Mul(b[k], v[k])));
            const V a_lo = hn::Mul(a[k], hn::Set(tag, lo.x)), a_hi = hn::Mul(a[k], hn::Set(tag, hi.x)),
                    b_lo = hn::Mul(b[k], hn::Set(tag, lo.y)), b_hi = hn::Mul(b[k], hn::Set(tag, hi.y));
            const V highest = hn::Add(hn::Add(hn::Max(a_lo, a_hi), hn::Max(b_lo, b_hi)), c[k]),
                    lowest = hn::Add(hn::Add(hn::Min(a_lo, a_hi), hn::Min(b_lo, b_hi)), c[k]);
            mask = hn::And(mask, hn::Ge(highest, zero));
            is_whole = hn::And(is_whole, hn::Ge(lowest, zero));
        }
        const auto is_cut = hn::Le(bottom, hn::Set(tag, tile.relief));
        if (!hn::AllFalse(tag, hn::AndNot(is_cut, is_whole))) {
            const std::uint32_t whole = bits_of(tag, hn::AndNot(is_cut, is_whole));
            tile.hits.assign(1, {0.0f, static_cast<std::uint32_t>(begin) + std::countr_zero(whole)});
            return true;
        }
        std::uint32_t hit = bits_of(tag, mask);
        if (!hit) continue;
        alignas(64) float shaded[kWidth];
        hn::Store(hn::Mul(hn::Sub(hn::Min(hi_u, hn::Set(tag, hi.x)), hn::Max(lo_u, hn::Set(tag, lo.x))),
                          hn::Sub(hn::Min(hi_v, hn::Set(tag, hi.y)), hn::Max(lo_v, hn::Set(tag, lo.y)))),
                  tag, shaded);
        for (std::uint32_t left = hit; left; left &= left - 1) {
            const std::uint32_t lane = static_cast<std::uint32_t>(std::countr_zero(left));
            tile.hits.emplace_back(-shaded[lane], static_cast<std::uint32_t>(begin) + lane);
        }
        shadows.is_cut = bits_of(tag, is_cut) & hit;
        if (shadows.is_cut) {
            // The quad's height over (u, v) along the direction: h is linear there.
            const V dh1 = hn::Sub(h[2], h[0]), dh2 = hn::Sub(h[3], h[1]), scale = hn::Abs(area);
            a[4] = hn::Mul(sign, hn::Sub(hn::Mul(dh1, dv2), hn::Mul(dh2, dv1)));
            b[4] = hn::Mul(sign, hn::Sub(hn::Mul(dh2, du1), hn::Mul(dh1, du2)));
            c[4] = hn::Sub(hn::Mul(h[0], scale), hn::Add(hn::Mul(a[4], u[0]), hn::Mul(b[4], v[0])));
            hn::Store(scale, tag, shadows.scale);
        }
        for (int k = 0; k < (shadows.is_cut ? 5 : 4); ++k) {
            hn::Store(a[k], tag, shadows.a[k]);
            hn::Store(b[k], tag, shadows.b[k]);
            hn::Store(c[k], tag, shadows.c[k]);
        }
        hn::Store(lo_v, tag, shadows.lo_v);
        hn::Store(hi_v, tag, shadows.hi_v);
        bool is_dark = true;
        for (ProjectionTile::Facet& facet : tile.facets) {
            if (!facet.is_dark) cast_on_facet(facet, shadows, hit, slope, margin);
            is_dark = is_dark && facet.is_dark;
        }
        if (blocks > 0) {
            for (; hit; hit &= hit - 1) {
                const std::size_t lane = static_cast<std::size_t>(std::countr_zero(hit));
                cast_on_points(tile, shadows, lane, row_of(shadows.lo_v[lane] - margin),
                               row_of(shadows.hi_v[lane] + margin) + 1, points_u, points_v);
            }
            for (const std::uint32_t block : tile.open_block) is_dark = is_dark && block == 0;
        }
        if (is_dark) return true;
    }
    return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace skybake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skybake {

namespace {

HWY_EXPORT(FindCandidates);
HWY_EXPORT(CastShadows);

constexpr float kLowestCosine = 0.01f;
// A point this near its texel's centre stands for it, texels; and this near a plane, for a point of it, metres: a few
// roundings of coordinates of a kilometre, and less than points are lifted off their surface, so that it does not shade
// itself.
constexpr float kRegular = 5e-3f;
constexpr float kFlat = 2e-4f;
// A triangle with fewer texels is not worth a facet.
constexpr std::size_t kFacetTexels = 24;
// A quad costs some 5 cycles a direction even where its shadow falls beside the tile, and a ray of a packet some 100:
// beyond so many quads rays are cheaper for tiles of a few hundred texels.
constexpr std::size_t kCrowded = 8192;

/// The plane h = slope · (u, v) + offset with the least squared distance from the points added.
class PlaneFit {
  public:
    void add(const Vec2d& uv, double h) {
        if (count_ == 0.0) first_ = {uv, h};
        const Vec2d d = uv - Vec2d(first_);  // about the first point: fewer digits are lost
        const double dh = h - first_.z;
        count_ += 1.0;
        sum_ += d;
        sum_h_ += dh;
        uu_ += d.x * d.x;
        uv_ += d.x * d.y;
        vv_ += d.y * d.y;
        uh_ += d.x * dh;
        vh_ += d.y * dh;
    }

    std::pair<Vec2f, float> plane() const {
        const Vec2d mean = sum_ / count_;
        const double mean_h = sum_h_ / count_;
        // A row or a single point says nothing of the slope across: a trace of weight on 0 decides it.
        constexpr double kFlatly = 1e-9;
        const double a = uu_ - count_ * mean.x * mean.x + kFlatly, b = uv_ - count_ * mean.x * mean.y,
                     d = vv_ - count_ * mean.y * mean.y + kFlatly, p = uh_ - count_ * mean.x * mean_h,
                     q = vh_ - count_ * mean.y * mean_h;
        const double determinant = a * d - b * b;
        const Vec2d slope = Vec2d(d * p - b * q, a * q - b * p) / determinant;
        return {Vec2f(slope), static_cast<float>(first_.z + mean_h - glm::dot(slope, mean + Vec2d(first_)))};
    }

  private:
    Vec3d first_{0.0};
    Vec2d sum_{0.0};
    double count_ = 0.0, sum_h_ = 0.0, uu_ = 0.0, uv_ = 0.0, vv_ = 0.0, uh_ = 0.0, vh_ = 0.0;
};

}  // namespace

DirectionBundles::DirectionBundles(std::span<const Vec3f> directions, std::span<const std::uint32_t> chosen)
    : order_(chosen.begin(), chosen.end()), begin_{0} {
    const auto halve = [&](const auto& self, std::span<std::uint32_t> run) -> void {
        if (run.size() <= kSize) {
            if (!run.empty()) begin_.push_back(begin_.back() + static_cast<std::uint32_t>(run.size()));
            return;
        }
        Box3f box;
        for (const std::uint32_t j : run) box.extend(directions[j]);
        const Vec3f size = box.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto middle = run.begin() + static_cast<std::ptrdiff_t>(run.size() / 2);
        std::nth_element(run.begin(), middle, run.end(), [&](std::uint32_t a, std::uint32_t b) {
            return directions[a][axis] != directions[b][axis] ? directions[a][axis] < directions[b][axis] : a < b;
        });
        self(self, run.first(run.size() / 2));
        self(self, run.subspan(run.size() / 2));
    };
    halve(halve, order_);
}

bool can_project(const Vec3f& normal, const Vec3f& direction) {
    return glm::dot(normal, direction) >= kLowestCosine;
}

ShadowProjector::ShadowProjector(const OccluderTree& tree, const TilePoints& points) : tree_(tree) {
    SKYBAKE_CHECK_LE(points.width, ProjectionTile::kMaxSize);
    SKYBAKE_CHECK_LE(points.height, ProjectionTile::kMaxSize);
    const TileFrame& frame = points.frame;
    tile_.width = points.width;
    tile_.height = points.height;
    tile_.axis_u = frame.u / glm::dot(frame.u, frame.u);
    tile_.axis_v = frame.v / glm::dot(frame.v, frame.v);
    tile_.axis_h = frame.normal;
    tile_.lo = Vec2f(std::numeric_limits<float>::max());
    tile_.hi = Vec2f(std::numeric_limits<float>::lowest());
    float lowest = std::numeric_limits<float>::max(), highest = std::numeric_limits<float>::lowest();
    std::vector<Vec3f> uvh(points.x.size());
    for (int row = 0; row < points.height; ++row) {
        for (std::uint64_t left = points.covered[row]; left; left &= left - 1) {
            const std::size_t i = static_cast<std::size_t>(points.texel(std::countr_zero(left), row));
            const Vec3f p = Vec3f(points.x[i], points.y[i], points.z[i]) - frame.origin;
            uvh[i] = {glm::dot(tile_.axis_u, p), glm::dot(tile_.axis_v, p), glm::dot(tile_.axis_h, p)};
            tile_.lo = glm::min(tile_.lo, Vec2f(uvh[i]));
            tile_.hi = glm::max(tile_.hi, Vec2f(uvh[i]));
            lowest = std::min(lowest, uvh[i].z);
            highest = std::max(highest, uvh[i].z);
        }
    }
    tile_.origin = frame.origin + lowest * frame.normal;
    tile_.relief = highest - lowest;
    for (Vec3f& point : uvh) point.z -= lowest;

    find_facets(points, uvh);
    tile_.open_block.resize(tile_.in_use.size());
    tile_.projected_u.resize(tile_.u.size());
    tile_.projected_v.resize(tile_.v.size());
}

void ShadowProjector::find_facets(const TilePoints& points, std::span<const Vec3f> uvh) {
    struct Texel {
        int row, column;
        std::uint32_t triangle;
        Vec3f uvh;
        Vec2f center() const { return {static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f}; }
    };
    std::vector<Texel> regular, loose;
    for (int row = 0; row < points.height; ++row) {
        for (std::uint64_t left = points.covered[row]; left; left &= left - 1) {
            const int column = std::countr_zero(left);
            const std::size_t i = static_cast<std::size_t>(points.texel(column, row));
            const Texel texel{row, column, points.triangle[i], uvh[i]};
            (glm::length(Vec2f(uvh[i]) - texel.center()) < kRegular ? regular : loose).push_back(texel);
        }
    }
    // All of one plane make one facet; else each triangle its own.
    const auto add_facet = [&](std::span<const Texel> texels) {
        PlaneFit fit;
        for (const Texel& texel : texels) fit.add(texel.center(), texel.uvh.z);
        const auto [slope, offset] = fit.plane();
        ProjectionTile::Facet facet;
        facet.slope = slope;
        facet.offset = offset;
        facet.row_begin = texels.front().row;
        facet.row_end = texels.back().row + 1;
        facet.lo = facet.hi = texels.front().center();
        for (const Texel& texel : texels) {
            const Vec2f center = texel.center();
            if (!(std::abs(glm::dot(slope, center) + offset - texel.uvh.z) < kFlat)) return false;
            facet.points[static_cast<std::size_t>(texel.row)] |= 1ull << texel.column;
            facet.lo = glm::min(facet.lo, center);
            facet.hi = glm::max(facet.hi, center);
        }
        tile_.facets.push_back(facet);
        return true;
    };
    if (!regular.empty() && !add_facet(regular)) {
        std::stable_sort(regular.begin(), regular.end(),
                         [](const Texel& a, const Texel& b) { return a.triangle < b.triangle; });
        for (auto begin = regular.begin(); begin != regular.end();) {
            const auto end =
                std::find_if(begin, regular.end(), [&](const Texel& t) { return t.triangle != begin->triangle; });
            const bool is_facet = static_cast<std::size_t>(end - begin) >= kFacetTexels && add_facet({begin, end});
            if (!is_facet) loose.insert(loose.end(), begin, end);
            begin = end;
        }
    }

    std::stable_sort(loose.begin(), loose.end(), [](const Texel& a, const Texel& b) {
        return std::tie(a.row, a.column) < std::tie(b.row, b.column);
    });
    std::size_t next = 0;
    for (int row = 0; row < points.height; ++row) {
        tile_.first_row.push_back(static_cast<std::uint32_t>(tile_.texel.size() / ProjectionTile::kBlock));
        for (; next < loose.size() && loose[next].row == row; ++next)
            add_loose_point(row, loose[next].column, loose[next].uvh);
        tile_.end_row.push_back(static_cast<std::uint32_t>(tile_.in_use.size()));
    }
    while (tile_.texel.size() % ProjectionTile::kBlock != 0) {
        add_loose_point(0, 0, Vec3f(std::numeric_limits<float>::quiet_NaN()));
        tile_.in_use.back() &= ~(1u << ((tile_.texel.size() - 1) % ProjectionTile::kBlock));
    }
}

void ShadowProjector::add_loose_point(int row, int column, const Vec3f& uvh) {
    const std::size_t lane = tile_.texel.size() % ProjectionTile::kBlock;
    if (lane == 0) tile_.in_use.push_back(0);
    tile_.in_use.back() |= 1u << lane;
    tile_.texel.push_back(static_cast<std::uint16_t>(row * 64 + column));
    tile_.u.push_back(uvh.x);
    tile_.v.push_back(uvh.y);
    tile_.h.push_back(uvh.z);
}

Vec2f ShadowProjector::slopes(const Vec3f& direction) const {
    return Vec2f(glm::dot(tile_.axis_u, direction), glm::dot(tile_.axis_v, direction)) /
           glm::dot(tile_.axis_h, direction);
}

void ShadowProjector::set_bundle(std::span<const Vec3f> directions, std::span<const std::uint32_t> bundle) {
    Box2f box;
    for (const std::uint32_t j : bundle) box.extend(slopes(directions[j]));
    range_ = {box.center(), 0.5f * box.size()};
    has_candidates_ = false;
}

/// Open: what is left is in the tile's facets and loose points.
ShadowProjector::Answer ShadowProjector::cast_shadows(const Vec2f& slope) {
    for (ProjectionTile::Facet& facet : tile_.facets) {
        std::copy(facet.points.begin() + facet.row_begin, facet.points.begin() + facet.row_end,
                  facet.open.begin() + facet.row_begin);
        facet.is_dark = false;
    }
    std::copy(tile_.in_use.begin(), tile_.in_use.end(), tile_.open_block.begin());
    if (tree_.is_empty()) return Answer::open;
    tile_.hits.clear();
    if (tile_.blockers.count > 0 && HWY_DYNAMIC_DISPATCH(CastShadows)(tile_, tile_.blockers, slope))
        return Answer::dark;
    if (!has_candidates_) {
        HWY_DYNAMIC_DISPATCH(FindCandidates)(tile_, tree_, range_);
        has_candidates_ = true;
    }
    if (tile_.candidates.count > kCrowded) return Answer::crowded;
    tile_.hits.clear();
    if (!HWY_DYNAMIC_DISPATCH(CastShadows)(tile_, tile_.candidates, slope)) return Answer::open;
    // The largest shadows are the likeliest to fall here again.
    const std::size_t count = std::min<std::size_t>(tile_.hits.size(), ProjectionTile::kBlock);
    std::partial_sort(tile_.hits.begin(), tile_.hits.begin() + static_cast<std::ptrdiff_t>(count), tile_.hits.end());
    tile_.blockers.count = count;
    for (std::size_t k = 0; k < tile_.blockers.corner.size(); ++k) {
        std::vector<float>& array = tile_.blockers.corner[k];
        array.assign(ProjectionTile::kBlock, std::numeric_limits<float>::quiet_NaN());
        for (std::size_t i = 0; i < count; ++i) array[i] = tile_.candidates.corner[k][tile_.hits[i].second];
    }
    return Answer::dark;
}

bool ShadowProjector::find_visible(const Vec3f& direction, std::span<std::uint64_t> visible) {
    const Answer answer = cast_shadows(slopes(direction));
    if (answer == Answer::crowded) return false;
    std::fill(visible.begin(), visible.end(), 0);
    if (answer == Answer::dark) return true;
    for (const ProjectionTile::Facet& facet : tile_.facets) {
        for (int row = facet.row_begin; row < facet.row_end; ++row)
            visible[row] |= facet.open[static_cast<std::size_t>(row)];
    }
    for (std::size_t block = 0; block < tile_.open_block.size(); ++block) {
        for (std::uint32_t left = tile_.open_block[block]; left; left &= left - 1) {
            const std::size_t i = block * ProjectionTile::kBlock + static_cast<std::size_t>(std::countr_zero(left));
            visible[tile_.texel[i] / 64] |= 1ull << (tile_.texel[i] % 64);
        }
    }
    return true;
}

}  // namespace skybake
#endif
