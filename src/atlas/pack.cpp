#include "atlas/pack.h"

#include <algorithm>
#include <deque>

#include "base/check.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#include <stb/stb_rect_pack.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace skybake {

namespace {

constexpr int kBlock = 4;  // two mip levels
constexpr int kPageBlocks = kMaxPageSize / kBlock;
// How much more area than a page holds is offered to it; empirical: above 1.3 pages get fuller by less than 1 %.
constexpr double kOffer = 1.3;

int blocks_of(int texels) {
    return (texels + 2 * kGutter + kBlock - 1) / kBlock;
}

}  // namespace

std::vector<AtlasPage> pack_charts(std::span<Chart> charts) {
    std::vector<AtlasPage> pages;
    std::deque<std::size_t> waiting;
    for (std::size_t i = 0; i < charts.size(); ++i) waiting.push_back(i);
    std::vector<stbrp_node> nodes(kPageBlocks);
    std::vector<stbrp_rect> rects;
    while (!waiting.empty()) {
        rects.clear();
        std::vector<std::size_t> offered;
        double area = 0.0;
        while (!waiting.empty() && area < kOffer * kPageBlocks * kPageBlocks) {
            const std::size_t i = waiting.front();
            waiting.pop_front();
            stbrp_rect rect{};
            rect.id = static_cast<int>(offered.size());
            rect.w = blocks_of(charts[i].size.x);
            rect.h = blocks_of(charts[i].size.y);
            SKYBAKE_CHECK_LE(std::max(rect.w, rect.h), kPageBlocks);
            area += static_cast<double>(rect.w) * rect.h;
            rects.push_back(rect);
            offered.push_back(i);
        }
        stbrp_context context;
        stbrp_init_target(&context, kPageBlocks, kPageBlocks, nodes.data(), kPageBlocks);
        stbrp_pack_rects(&context, rects.data(), static_cast<int>(rects.size()));
        AtlasPage page;
        std::vector<std::size_t> left_over;
        for (const stbrp_rect& rect : rects) {
            const std::size_t i = offered[static_cast<std::size_t>(rect.id)];
            if (!rect.was_packed) {
                left_over.push_back(i);
                continue;
            }
            charts[i].page = PageId(pages.size());
            charts[i].position = Vec2i(rect.x * kBlock + kGutter, rect.y * kBlock + kGutter);
            page.width = std::max(page.width, (rect.x + rect.w) * kBlock);
            page.height = std::max(page.height, (rect.y + rect.h) * kBlock);
        }
        SKYBAKE_CHECK_LT(left_over.size(), offered.size());
        std::sort(left_over.begin(), left_over.end());
        waiting.insert(waiting.begin(), left_over.begin(), left_over.end());
        pages.push_back(page);
    }
    return pages;
}

}  // namespace skybake
