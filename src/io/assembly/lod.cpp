#include "io/assembly/lod.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"

namespace skybake::io {

std::optional<Lod> parse_lod(std::string_view text) {
    Lod lod;
    lod.text = text;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), lod.value);
    const bool is_number = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
    return is_number && std::isfinite(lod.value) && lod.value >= 0.0 ? std::optional(lod) : std::nullopt;
}

LodChoice lod_choice(const std::optional<std::string>& option) {
    if (!option) return {};
    const std::optional<Lod> lod = parse_lod(*option);
    if (!lod || lod->value >= 10.0)
        throw InputError(fmt::format("--lod {}: is no level of detail. Say 1, 1.3, 2, 2.2 …", *option));
    return {lod};
}

Lod choose_lod(std::span<const Lod> offered, const LodChoice& choice) {
    const auto less = [](const Lod& a, const Lod& b) { return a.value < b.value; };
    if (!choice.asked) return *std::max_element(offered.begin(), offered.end(), less);
    const double asked = choice.asked->value;
    const bool is_whole = choice.asked->text.find('.') == std::string::npos;
    const auto rank = [&](const Lod& lod) {  // lower is better
        if (lod.value == asked) return 0.0;
        if (is_whole && std::floor(lod.value) == asked) return 1.0 - (lod.value - asked) * 0.5;
        return lod.value < asked ? 10.0 + (asked - lod.value) : 100.0 + (lod.value - asked);
    };
    return *std::min_element(offered.begin(), offered.end(),
                             [&](const Lod& a, const Lod& b) { return rank(a) < rank(b); });
}

bool fits(const Lod& taken, const Lod& asked) {
    return taken.value == asked.value ||
           (asked.text.find('.') == std::string::npos && std::floor(taken.value) == asked.value);
}

}  // namespace skybake::io
