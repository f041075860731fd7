#include "io/photometry/profile_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "base/error.h"

namespace skybake::io {
namespace {

constexpr std::string_view kBlanks = " \t\f\v";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

bool is_near(double a, double b) {
    return std::abs(a - b) < 1e-3;
}

}  // namespace

ProfileText::ProfileText(std::string name, std::string_view text) : name_(std::move(name)) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        lines_.push_back(trimmed(text.substr(0, end)));
        const bool is_pair = text.substr(end).starts_with("\r\n");
        text.remove_prefix(std::min(end + (is_pair ? 2 : 1), text.size()));
    }
}

void ProfileText::fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}. Take the file as its maker publishes it.", name_, line_, what));
}

std::string_view ProfileText::line(const char* what) {
    rest_ = {};
    if (at_end()) fail(fmt::format("the file ends before {}", what));
    return lines_[line_++];
}

double ProfileText::parsed(std::string_view word, const char* what, double lowest, double highest) const {
    std::string digits(word.substr(0, 40));
    for (char& c : digits) c = c == ',' ? '.' : c;
    const char* begin = digits.data() + (digits.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(begin, digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) fail(fmt::format("{} is no number", what));
    if (!(value >= lowest && value <= highest))
        fail(fmt::format("{} is {}, not within {} and {}", what, value, lowest, highest));
    return value;
}

double ProfileText::number_on_line(const char* what, double lowest, double highest) {
    return parsed(line(what), what, lowest, highest);
}

double ProfileText::number(const char* what, double lowest, double highest) {
    constexpr std::string_view kParting = " \t\f\v,";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kParting), rest_.size()));
    while (rest_.empty()) {
        rest_ = line(what);
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kParting), rest_.size()));
    }
    const std::size_t end = std::min(rest_.find_first_of(kParting), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return parsed(word, what, lowest, highest);
}

std::vector<double> ascending_angles(ProfileText& text, std::size_t count, const char* what, bool is_one_a_line) {
    std::vector<double> angles;
    for (std::size_t i = 0; i < count; ++i) {
        angles.push_back(is_one_a_line ? text.number_on_line(what, -360.0, 360.0) : text.number(what, -360.0, 360.0));
        if (i > 0 && !(angles[i] > angles[i - 1])) text.fail(fmt::format("{}: they do not ascend", what));
    }
    return angles;
}

LightProfile completed_profile(const ProfileText& text, const std::vector<double>& c_deg,
                               const std::vector<double>& gamma_deg, const std::vector<double>& candela) {
    if (gamma_deg.size() < 2 || gamma_deg.front() < 0.0 || gamma_deg.back() > 180.0)
        text.fail("the vertical angles are not two or more within 0 and 180");
    struct Plane {
        double c_deg;
        std::size_t source;
    };
    std::vector<Plane> planes;
    const double first = c_deg.front(), last = c_deg.back();
    const std::size_t count = c_deg.size();
    const auto copy = [&](double turn, double sign, std::size_t begin, std::size_t end) {
        // Ascending whichever way the source is walked.
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t source = sign > 0.0 ? i : end - 1 - (i - begin);
            planes.push_back({turn + sign * c_deg[source], source});
        }
    };
    if (count == 1) {
        planes.push_back({0.0, 0});
    } else if (is_near(first, 0.0) && is_near(last, 90.0)) {
        copy(0.0, 1.0, 0, count);
        copy(180.0, -1.0, 0, count - 1);
        copy(180.0, 1.0, 1, count);
        copy(360.0, -1.0, 1, count - 1);
    } else if (is_near(first, 0.0) && is_near(last, 180.0)) {
        copy(0.0, 1.0, 0, count);
        copy(360.0, -1.0, 1, count - 1);
    } else if (is_near(first, 90.0) && is_near(last, 270.0)) {
        // About the plane through C = 90° and 270°: C goes over into 180° - C.
        for (std::size_t i = count; i-- > 0;) {
            if (c_deg[i] <= 180.0 + 1e-3) planes.push_back({180.0 - c_deg[i], i});
        }
        copy(0.0, 1.0, 1, count);
        for (std::size_t i = count - 1; i-- > 0;) {
            if (c_deg[i] > 180.0 + 1e-3) planes.push_back({540.0 - c_deg[i], i});
        }
    } else if (is_near(first, 0.0) && last > 180.0) {
        copy(0.0, 1.0, 0, is_near(last, 360.0) ? count - 1 : count);
    } else {
        text.fail(fmt::format("the horizontal angles run from {} to {}, which no symmetry completes", first, last));
    }
    std::vector<double> c, gamma, values;
    for (const Plane& plane : planes) {
        c.push_back(radians_from_degrees(std::max(plane.c_deg, 0.0)));
        const auto row = candela.begin() + static_cast<std::ptrdiff_t>(plane.source * gamma_deg.size());
        values.insert(values.end(), row, row + static_cast<std::ptrdiff_t>(gamma_deg.size()));
    }
    for (const double angle : gamma_deg) gamma.push_back(radians_from_degrees(angle));
    bool is_dark = true;
    for (const double value : values) is_dark = is_dark && !(value > 0.0);
    if (is_dark) text.fail("all intensities are 0");
    return {std::move(c), std::move(gamma), std::move(values)};
}

}  // namespace skybake::io
