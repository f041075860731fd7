// The error of ground and walls against the number of directions, for every kind of sky: a table on stdout, and, with a
// path, a plot of it as SVG.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "dome_error.h"

namespace skybake {
namespace {

constexpr std::array<int, 6> kCounts = {128, 256, 512, 1024, 2048, 4096};

/// Errors in per cent, one for each of kCounts.
using Series = std::array<double, kCounts.size()>;

struct Result {
    std::string sky;
    Series bare_free{};   // worst, free ground and walls, without the ratio to the table
    Series obstructed{};  // root mean square over half domes, streets and walls in streets
};

Result judge(const NamedSky& sky) {
    Result result{sky.name};
    int obstructed = 0;
    for (const Obstacle& obstacle : obstacles_to_judge()) {
        const double exact = exact_illuminance(sky.daylight.sky, obstacle);
        const bool is_free = obstacle.name.starts_with("free");
        if (!is_free) ++obstructed;
        for (std::size_t i = 0; i < kCounts.size(); ++i) {
            const double value = is_free ? unscaled_illuminance(sky.sampler, sky.daylight.sky, obstacle, kCounts[i])
                                         : sampled_illuminance(sky.sampler, obstacle, kCounts[i]);
            const double error = 100.0 * std::abs(value / exact - 1.0);
            if (is_free) {
                result.bare_free[i] = std::max(result.bare_free[i], error);
            } else {
                result.obstructed[i] += error * error;
            }
        }
    }
    for (double& squares : result.obstructed) squares = std::sqrt(squares / obstructed);
    return result;
}

void print_table(const char* title, const std::vector<Result>& results, Series Result::*series) {
    fmt::print("{}\n\n| sky |", title);
    for (const int count : kCounts) fmt::print(" {} |", count);
    fmt::print("\n|---|");
    for (std::size_t i = 0; i < kCounts.size(); ++i) fmt::print("---|");
    for (const Result& result : results) {
        fmt::print("\n| {} |", result.sky);
        for (const double error : result.*series) fmt::print(" {:.2f} |", error);
    }
    fmt::print("\n\n");
}

/// One panel: a line for each sky, both axes logarithmic.
std::string panel(const std::vector<Result>& results, Series Result::*series, const char* title, double left) {
    constexpr double kWidth = 300.0, kHeight = 240.0, kLow = 1e-3, kHigh = 10.0;
    const auto x = [&](double count) {
        return left + kWidth * std::log(count / kCounts.front()) / std::log(double(kCounts.back()) / kCounts.front());
    };
    const auto y = [&](double error) {
        return 40.0 + kHeight * std::log(kHigh / std::clamp(error, kLow, kHigh)) / std::log(kHigh / kLow);
    };
    std::string svg = fmt::format("<text x='{:.0f}' y='24' font-size='13'>{}</text>\n", left, title);
    for (const double error : {0.001, 0.01, 0.1, 1.0, 10.0}) {
        svg += fmt::format(
            "<line x1='{0:.0f}' x2='{1:.0f}' y1='{2:.1f}' y2='{2:.1f}' stroke='#ddd'/>"
            "<text x='{3:.0f}' y='{4:.1f}' text-anchor='end'>{5:g} %</text>\n",
            left, left + kWidth, y(error), left - 6.0, y(error) + 4.0, error);
    }
    for (const int count : kCounts)
        svg += fmt::format("<text x='{:.1f}' y='296' text-anchor='middle'>{}</text>\n", x(count), count);
    for (std::size_t i = 0; i < results.size(); ++i) {
        const bool is_image = results[i].sky.starts_with("image");
        svg +=
            fmt::format("<polyline fill='none' stroke='{}' stroke-width='1.5' points='",
                        is_image ? std::string("#d03030")
                                 : fmt::format("hsl({:.0f},55%,45%)", 180.0 + 100.0 * static_cast<double>(i) /
                                                                                  static_cast<double>(results.size())));
        for (std::size_t k = 0; k < kCounts.size(); ++k)
            svg += fmt::format("{:.1f},{:.1f} ", x(kCounts[k]), y((results[i].*series)[k]));
        svg += fmt::format("'><title>{}</title></polyline>\n", results[i].sky);
    }
    return svg;
}

int run(int argument_count, char** arguments) {
    std::vector<Result> results;
    for (const NamedSky& sky : skies_to_judge()) results.push_back(judge(sky));
    print_table("Free ground and walls, without the ratio: worst error in %", results, &Result::bare_free);
    print_table("Half domes, streets, walls in streets: root mean square error in %", results, &Result::obstructed);
    if (argument_count > 1) {
        std::ofstream(arguments[1])
            << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 760 320' font-family='sans-serif' "
               "font-size='11'>\n"
            << "<rect width='760' height='320' fill='white'/>\n"
            << panel(results, &Result::bare_free, "free ground and walls, without the ratio: worst", 60.0)
            << panel(results, &Result::obstructed, "behind obstacles: root mean square", 440.0)
            << "<text x='380' y='314' text-anchor='middle'>directions N; blue to violet: formulas, red: a picture with "
               "its sun</text>\n</svg>\n";
    }
    return 0;
}

}  // namespace
}  // namespace skybake

int main(int argument_count, char** arguments) {
    return skybake::run(argument_count, arguments);
}
