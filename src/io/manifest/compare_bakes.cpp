#include "io/manifest/compare_bakes.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "base/error.h"
#include "io/exr/exr.h"

namespace skybake::io {
namespace {

constexpr int kRowsAtOnce = 64;
constexpr std::array kParts = {LightPart::total, LightPart::sun, LightPart::sky, LightPart::indirect};

struct Sums {
    std::uint64_t texels = 0;
    double reference = 0.0;
    double difference = 0.0;
    double square = 0.0;
    double max_abs = 0.0;

    void add(double a, double b) {
        const double d = a - b;
        ++texels;
        reference += b;
        difference += d;
        square += d * d;
        max_abs = std::max(max_abs, std::abs(d));
    }
    void add(const Sums& other) {
        texels += other.texels;
        reference += other.reference;
        difference += other.difference;
        square += other.square;
        max_abs = std::max(max_abs, other.max_abs);
    }
    Deviation deviation() const {
        if (texels == 0) return {};
        const double n = static_cast<double>(texels);
        return {texels, reference / n, difference / n, std::sqrt(square / n), max_abs};
    }
};

using PartSums = std::array<Sums, kParts.size()>;

void add(PartSums& sums, const PartSums& more) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k].add(more[k]);
}

PartDeviations deviations_of(const PartSums& sums, std::uint64_t texels_off) {
    return {sums[0].deviation(), sums[1].deviation(), sums[2].deviation(), sums[3].deviation(), texels_off};
}

/// Which texels of a page count, and which chart they belong to.
struct PageMask {
    std::vector<std::uint8_t> is_compared;
    std::vector<std::uint32_t> chart;
    std::uint64_t buried_in_one = 0;
};

bool is_of_chart(TexelState state) {
    return state == TexelState::chart || state == TexelState::buried;
}

[[noreturn]] void fail_atlas(const StoredBake& a, const StoredBake& b, const std::string& what) {
    throw InputError(
        fmt::format("{} and {}: are not bakes of one atlas: {}. Bake the same city with the same --texel and --lod.",
                    a.folder.string(), b.folder.string(), what));
}

PageMask page_mask(const StoredBake& a, const StoredBake& b, std::size_t page) {
    const LightmapPage base_a = read_base(a, page);
    const LightmapPage base_b = read_base(b, page);
    PageMask mask;
    mask.is_compared.resize(base_a.state.size());
    mask.chart.resize(base_a.state.size());
    for (std::size_t t = 0; t < base_a.state.size(); ++t) {
        const bool is_of_a = is_of_chart(base_a.state[t]);
        const bool is_of_b = is_of_chart(base_b.state[t]);
        if (is_of_a != is_of_b || (is_of_a && base_a.chart[t] != base_b.chart[t])) {
            const std::size_t width = static_cast<std::size_t>(base_a.width);
            fail_atlas(
                a, b,
                fmt::format("page {}, column {}, row {} belongs to {} in the one and to {} in the other", page,
                            t % width, t / width, is_of_a ? fmt::format("chart {}", base_a.chart[t].value) : "none",
                            is_of_b ? fmt::format("chart {}", base_b.chart[t].value) : "none"));
        }
        if (!is_of_a) continue;
        mask.chart[t] = base_a.chart[t].value;
        mask.is_compared[t] = base_a.state[t] == TexelState::chart && base_b.state[t] == TexelState::chart;
        mask.buried_in_one += base_a.state[t] != base_b.state[t];
    }
    return mask;
}

void check_same_atlas(const StoredBake& a, const StoredBake& b) {
    if (a.texel_m != b.texel_m) fail_atlas(a, b, fmt::format("texels are {} m and {} m", a.texel_m, b.texel_m));
    if (a.charts != b.charts) fail_atlas(a, b, fmt::format("{} charts and {}", a.charts, b.charts));
    if (a.pages.size() != b.pages.size())
        fail_atlas(a, b, fmt::format("{} pages and {}", a.pages.size(), b.pages.size()));
    for (std::size_t p = 0; p < a.pages.size(); ++p) {
        if (a.pages[p].width == b.pages[p].width && a.pages[p].height == b.pages[p].height) continue;
        fail_atlas(a, b,
                   fmt::format("page {} has {} x {} texels and {} x {}", p, a.pages[p].width, a.pages[p].height,
                               b.pages[p].width, b.pages[p].height));
    }
    if (a.instants.size() != b.instants.size()) {
        throw InputError(fmt::format("{} and {}: have {} instants and {}. Bake both with the same --at.",
                                     a.folder.string(), b.folder.string(), a.instants.size(), b.instants.size()));
    }
}

/// Reads a light EXR stripe by stripe, as luminance of each part.
class LuminanceReader {
  public:
    LuminanceReader(const StoredBake& bake, std::size_t instant, std::size_t page)
        : path_(bake.instants[instant].pages[page]), reader_(path_) {
        const StoredPage& stored = bake.pages[page];
        if (reader_.width() != stored.width || reader_.height() != stored.height) {
            throw InputError(fmt::format("{}: has {} x {} texels, and the manifest says {} x {}. Bake again.",
                                         path_.string(), reader_.width(), reader_.height(), stored.width,
                                         stored.height));
        }
        const std::size_t room = static_cast<std::size_t>(stored.width) * kRowsAtOnce;
        for (std::size_t k = 0; k < kParts.size(); ++k) {
            pixels_[k].assign(room, Rgb(0.0f));
            if (kParts[k] == LightPart::indirect && !bake.instants[instant].has_indirect) continue;
            const std::array<std::string, 3> names = channel_names(kParts[k]);
            for (std::size_t c = 0; c < 3; ++c)
                targets_.push_back({{names[c], ExrType::float32}, &pixels_[k].data()->x + c, 3});
        }
    }

    void read(int first_row, int row_count) { reader_.read_rows(first_row, row_count, targets_); }

    double luminance_at(std::size_t part, std::size_t texel) const {
        const double value = static_cast<double>(luminance(pixels_[part][texel]));
        if (!std::isfinite(value))
            throw InputError(fmt::format("{}: holds light that is not finite. Bake again.", path_.string()));
        return value;
    }

  private:
    std::filesystem::path path_;
    ExrReader reader_;
    std::array<std::vector<Rgb>, kParts.size()> pixels_;
    std::vector<ExrReader::Target> targets_;
};

/// One page of one instant.
struct PageDifference {
    PartSums sums;
    std::vector<float> difference;  // of the total, lx; 0 where nothing is compared
    std::vector<float> reference;
};

PageDifference page_difference(const StoredBake& a, const StoredBake& b, std::size_t instant, std::size_t page,
                               const PageMask& mask) {
    LuminanceReader reader_a(a, instant, page);
    LuminanceReader reader_b(b, instant, page);
    const int height = a.pages[page].height;
    const std::size_t width = static_cast<std::size_t>(a.pages[page].width);
    PageDifference result;
    result.difference.resize(mask.is_compared.size());
    result.reference.resize(mask.is_compared.size());
    for (int first = 0; first < height; first += kRowsAtOnce) {
        const int rows = std::min(kRowsAtOnce, height - first);
        reader_a.read(first, rows);
        reader_b.read(first, rows);
        const std::size_t begin = static_cast<std::size_t>(first) * width;
        for (std::size_t i = 0; i < static_cast<std::size_t>(rows) * width; ++i) {
            if (mask.is_compared[begin + i] == 0) continue;
            for (std::size_t k = 0; k < kParts.size(); ++k) {
                const double value_a = reader_a.luminance_at(k, i);
                const double value_b = reader_b.luminance_at(k, i);
                result.sums[k].add(value_a, value_b);
                if (k > 0) continue;
                result.difference[begin + i] = static_cast<float>(value_a - value_b);
                result.reference[begin + i] = static_cast<float>(value_b);
            }
        }
    }
    return result;
}

/// The worst texel of each chart, and from them the worst of all.
class WorstFinder {
  public:
    explicit WorstFinder(std::size_t keep) : keep_(keep) {}

    void add_page(std::size_t instant, std::size_t page, int width, const PageMask& mask,
                  const PageDifference& difference) {
        if (keep_ == 0) return;
        chart_worst_.clear();
        for (std::size_t t = 0; t < mask.is_compared.size(); ++t) {
            if (mask.is_compared[t] == 0 || difference.difference[t] == 0.0f) continue;
            if (chart_worst_.size() <= mask.chart[t]) chart_worst_.resize(mask.chart[t] + std::size_t{1}, kNone);
            std::size_t& worst = chart_worst_[mask.chart[t]];
            if (worst == kNone || std::abs(difference.difference[t]) > std::abs(difference.difference[worst]))
                worst = t;
        }
        for (std::size_t chart = 0; chart < chart_worst_.size(); ++chart) {
            const std::size_t t = chart_worst_[chart];
            if (t == kNone) continue;
            const double b = static_cast<double>(difference.reference[t]);
            places_.push_back({instant, page, static_cast<std::uint32_t>(chart),
                               static_cast<int>(t % static_cast<std::size_t>(width)),
                               static_cast<int>(t / static_cast<std::size_t>(width)),
                               b + static_cast<double>(difference.difference[t]), b});
        }
        keep_worst();
    }

    const std::vector<WorstPlace>& places() const { return places_; }

  private:
    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

    void keep_worst() {
        // Stable, so that of equals the earlier page and chart stands first.
        std::stable_sort(places_.begin(), places_.end(), [](const WorstPlace& x, const WorstPlace& y) {
            return std::abs(x.a_lx - x.b_lx) > std::abs(y.a_lx - y.b_lx);
        });
        if (places_.size() > keep_) places_.resize(keep_);
    }

    std::size_t keep_;
    std::vector<std::size_t> chart_worst_;
    std::vector<WorstPlace> places_;
};

std::array<std::uint8_t, 3> diverging_color(double share) {
    const double s = std::clamp(share, -1.0, 1.0);
    // Through white, to the dark red and the dark blue of Moreland's diverging map ("Diverging color maps for
    // scientific visualization", 2009).
    const std::array<double, 3> end = s > 0.0 ? std::array<double, 3>{180, 4, 38} : std::array<double, 3>{59, 76, 192};
    std::array<std::uint8_t, 3> color{};
    for (std::size_t c = 0; c < 3; ++c)
        color[c] = static_cast<std::uint8_t>(std::lround(255.0 + (end[c] - 255.0) * std::abs(s)));
    return color;
}

}  // namespace

Image8 difference_picture(const std::vector<float>& difference_lx, const std::vector<std::uint8_t>& is_compared,
                          int width, int height, double range_lx) {
    constexpr int kBarHeight = 16;
    constexpr std::uint8_t kNothing = 96;
    Image8 image{width, height + kBarHeight, 3, {}};
    image.pixels.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3);
    for (std::size_t t = 0; t < difference_lx.size(); ++t) {
        if (is_compared[t] == 0) {
            image.pixels.insert(image.pixels.end(), {kNothing, kNothing, kNothing});
        } else {
            const std::array<std::uint8_t, 3> color =
                diverging_color(range_lx > 0.0 ? static_cast<double>(difference_lx[t]) / range_lx : 0.0);
            image.pixels.insert(image.pixels.end(), color.begin(), color.end());
        }
    }
    for (int y = 0; y < kBarHeight; ++y) {
        for (int x = 0; x < width; ++x) {
            const double share = width > 1 ? 2.0 * x / (width - 1) - 1.0 : 0.0;
            bool is_tick = false;
            for (int k = 0; k <= 4; ++k) is_tick = is_tick || (x == (k * (width - 1) + 2) / 4 && y < kBarHeight / 2);
            const std::array<std::uint8_t, 3> color =
                is_tick ? std::array<std::uint8_t, 3>{0, 0, 0} : diverging_color(share);
            image.pixels.insert(image.pixels.end(), color.begin(), color.end());
        }
    }
    return image;
}

Image8 leak_picture(const Lightmaps& light, std::size_t instant, std::size_t page, double range_lx) {
    const LightmapPage& own = light.pages[page];
    std::vector<std::uint8_t> is_shown(own.state.size());
    for (std::size_t t = 0; t < is_shown.size(); ++t) is_shown[t] = own.state[t] == TexelState::chart;
    return difference_picture(light.instants[instant].pages[page].leak, is_shown, own.width, own.height, range_lx);
}

BakeComparison compare_bakes(const StoredBake& a, const StoredBake& b, const CompareOptions& options,
                             Progress& progress) {
    check_same_atlas(a, b);
    if (options.picture_folder) {
        std::error_code error;
        std::filesystem::create_directories(*options.picture_folder, error);
        if (error)
            throw InputError(fmt::format("{}: cannot be made ({}). Choose another place.",
                                         options.picture_folder->string(), error.message()));
    }
    const std::size_t page_count = a.pages.size();
    progress.begin("compare", page_count * (a.instants.size() + 1));
    const auto step = [&] {
        if (progress.stop_requested()) throw Interrupted();
        progress.advance(1);
    };

    BakeComparison comparison;
    std::vector<PageMask> masks(page_count);
    tbb::parallel_for(std::size_t{0}, page_count, [&](std::size_t p) {
        masks[p] = page_mask(a, b, p);
        step();
    });
    for (const PageMask& mask : masks) comparison.buried_in_one += mask.buried_in_one;

    PartSums all;
    std::uint64_t all_off = 0;
    WorstFinder worst(options.worst_count);
    for (std::size_t i = 0; i < a.instants.size(); ++i) {
        std::vector<PageDifference> pages(page_count);
        tbb::parallel_for(std::size_t{0}, page_count, [&](std::size_t p) {
            pages[p] = page_difference(a, b, i, p, masks[p]);
            step();
        });
        PartSums sums;
        for (const PageDifference& page : pages)
            add(sums, page.sums);  // in the order of the pages: the same sum for any number of threads
        const double off = kOffShare * sums[0].deviation().mean;
        std::uint64_t texels_off = 0;
        for (std::size_t p = 0; p < page_count; ++p) {
            for (const float d : pages[p].difference) texels_off += static_cast<double>(std::abs(d)) > off;
            worst.add_page(i, p, a.pages[p].width, masks[p], pages[p]);
        }
        if (options.picture_folder) {
            const double range = options.picture_range_lx.value_or(off);
            for (std::size_t p = 0; p < page_count; ++p) {
                comparison.pictures.push_back(fmt::format("i{}_p{}_plus_minus_{:.4g}lx.png", i, p, range));
                write_png(*options.picture_folder / comparison.pictures.back(),
                          difference_picture(pages[p].difference, masks[p].is_compared, a.pages[p].width,
                                             a.pages[p].height, range));
            }
        }
        comparison.instants.push_back({a.instants[i].label, b.instants[i].label, deviations_of(sums, texels_off)});
        add(all, sums);
        all_off += texels_off;
    }
    comparison.all = deviations_of(all, all_off);
    comparison.worst = worst.places();
    return comparison;
}

}  // namespace skybake::io
