#include "bake_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/nearest_word.h"
#include "sky/utc_time.h"

namespace skybake::cli {
namespace {

/// None for what is no time, such as the label of a sun's direction.
std::optional<UtcTime> time_of(const std::string& text) {
    try {
        return parse_instant(text, std::nullopt).utc;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace

void unknown_word(const std::string& option, const std::string& given, const std::vector<std::string>& known) {
    throw InputError(fmt::format("{} '{}' is unknown; did you mean '{}'? Known: {}.", option, given,
                                 nearest_word(given, known), fmt::join(known, ", ")));
}

std::size_t instant_of(const io::StoredBake& bake, const std::string& at, const std::optional<ViewLink>& link) {
    if (bake.instants.empty()) throw InputError(fmt::format("{}: holds no instant. Bake again.", bake.folder.string()));
    if (at.empty()) {
        const std::size_t index = link && link->instant ? *link->instant : 0;
        if (index < bake.instants.size()) return index;
        throw InputError(fmt::format("--camera: names instant {}, and the bake has {}. Name one with --at.", index,
                                     bake.instants.size()));
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(at.data(), at.data() + at.size(), index);
    if (error == std::errc{} && end == at.data() + at.size() && index < bake.instants.size()) return index;
    const std::optional<UtcTime> time = time_of(at);  // however it is written
    std::vector<std::string> labels;
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < bake.instants.size(); ++i) {
        labels.push_back(bake.instants[i].label);
        if (labels.back() == at || (time && time_of(labels.back()) == time)) return i;
        if (labels.back().starts_with(at)) found.push_back(i);
    }
    if (found.size() == 1) return found.front();
    throw InputError(fmt::format("--at '{}': {} of the bake's instants. They are, from 0 on: {}.", at,
                                 found.empty() ? "is none" : "begins several", fmt::join(labels, ", ")));
}

io::PartFactors parts_of(const std::string& text, const std::vector<std::string>& known) {
    io::PartFactors parts;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        const std::string part = text.substr(begin, comma - begin);
        begin = comma + 1;
        const std::size_t equals = std::min(part.find('='), part.size());
        const std::string name = part.substr(0, equals);
        if (std::find(known.begin(), known.end(), name) == known.end()) unknown_word("--parts", name, known);
        float factor = 1.0f;
        if (equals < part.size()) {
            const char* end = part.data() + part.size();
            const auto [stop, error] = std::from_chars(part.data() + equals + 1, end, factor);
            if (error != std::errc{} || stop != end || !(factor >= 0.0f) || !std::isfinite(factor))
                throw InputError(fmt::format("--parts '{}': the factor is no number of 0 or more.", part));
        }
        parts.emplace_back(name, factor);
    }
    return parts;
}

io::PartFactors parts_of(const ViewLink& link, const std::vector<std::string>& known) {
    io::PartFactors parts;
    bool is_whole = true;
    for (const std::string& name : known) {
        float factor = 1.0f;
        for (const auto& [part, scale] : link.factors) {
            if (part == name) factor = scale;
        }
        if (std::find(link.off.begin(), link.off.end(), name) != link.off.end()) factor = 0.0f;
        is_whole = is_whole && factor == 1.0f;
        parts.emplace_back(name, factor);
    }
    return is_whole ? io::PartFactors{} : parts;
}

}  // namespace skybake::cli
