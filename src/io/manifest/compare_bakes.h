// How far two bakes of one atlas are apart, texel by texel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "io/image/image.h"
#include "io/manifest/read_bake.h"

namespace skybake::io {

/// Of the luminance-weighted illuminance (lx), A less B, over all texels that belong to a chart and are buried in
/// neither bake.
struct Deviation {
    std::uint64_t texels = 0;
    double mean = 0.0;  // of the reference B
    double bias = 0.0;  // mean of A − B
    double rmse = 0.0;
    double max_abs = 0.0;
    double rmse_over_mean() const { return mean > 0.0 ? rmse / mean : 0.0; }
};

struct PartDeviations {
    Deviation total;
    Deviation sun;
    Deviation sky;
    Deviation indirect;            // 0 in a bake without reflected light
    std::uint64_t texels_off = 0;  // whose total is off by more than kOffShare of their instant's mean
};

inline constexpr double kOffShare = 0.1;

struct InstantComparison {
    std::string label_a;
    std::string label_b;
    PartDeviations deviations;
};

/// The worst texel of a chart.
struct WorstPlace {
    std::size_t instant = 0;
    std::size_t page = 0;
    std::uint32_t chart = 0;
    int column = 0;
    int row = 0;
    double a_lx = 0.0;
    double b_lx = 0.0;
};

struct BakeComparison {
    PartDeviations all;  // all instants together
    std::vector<InstantComparison> instants;
    std::vector<WorstPlace> worst;      // of different charts of one instant, the worst first
    std::uint64_t buried_in_one = 0;    // texels that only one of the bakes calls buried; they are left out
    std::vector<std::string> pictures;  // names of the files that were written
};

struct CompareOptions {
    std::size_t worst_count = 10;
    std::optional<std::filesystem::path> picture_folder;
    /// Illuminance of the strongest colour of the pictures; otherwise kOffShare of the instant's mean, so that full
    /// colour means "off".
    std::optional<double> picture_range_lx;
};

/// Instants are compared in their order. Throws InputError when the bakes are not of one atlas (naming what differs),
/// when one has other instants in number, when a file is broken, or when a value is not finite; Interrupted when the
/// user stops. Memory: one page's differences an instant; the files are read in stripes.
BakeComparison compare_bakes(const StoredBake& a, const StoredBake& b, const CompareOptions& options,
                             Progress& progress);

/// Signed differences (lx) as colours: blue where A is darker, white where equal, red where A is brighter, full at ±
/// `range_lx`; grey where `is_compared` is 0. Below the page stands a bar with the scale from −range to +range, with
/// ticks at each half.
Image8 difference_picture(const std::vector<float>& difference_lx, const std::vector<std::uint8_t>& is_compared,
                          int width, int height, double range_lx);

/// LightmapLayer::leak as such a picture: red where feelers keep light out, blue where they let more in.
Image8 leak_picture(const Lightmaps& light, std::size_t instant, std::size_t page, double range_lx);

}  // namespace skybake::io
