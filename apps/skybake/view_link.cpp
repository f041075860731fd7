#include "view_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include "base/error.h"

namespace skybake::cli {
namespace {

/// With %2C and the like decoded: some programs escape what they paste.
std::string unescaped(std::string_view text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned code = 0;
        const char* begin = text.data() + i + 1;
        if (text[i] == '%' && i + 2 < text.size() && std::from_chars(begin, begin + 2, code, 16).ptr == begin + 2) {
            plain += static_cast<char>(code);
            i += 2;
        } else {
            plain += text[i];
        }
    }
    return plain;
}

template <typename Number>
std::optional<Number> number_of(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return {};
    if constexpr (std::is_floating_point_v<Number>) {
        if (!std::isfinite(value)) return {};
    }
    return value;
}

std::optional<Vec3f> vec3_of(std::string_view text) {
    Vec3f value(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = axis < 2 ? text.find(',') : text.size();
        if (comma == std::string_view::npos) return {};
        const std::optional<float> number = number_of<float>(text.substr(0, comma));
        if (!number) return {};
        value[axis] = *number;
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return value;
}

/// What stands between commas.
std::vector<std::string_view> split(std::string_view text) {
    std::vector<std::string_view> words;
    while (!text.empty()) {
        words.push_back(text.substr(0, text.find(',')));
        text.remove_prefix(std::min(words.back().size() + 1, text.size()));
    }
    return words;
}

}  // namespace

ViewLink parse_view_link(const std::string& link) {
    const auto fail = [&](const std::string& fault) {
        throw InputError(fmt::format(
            "--camera '{}': {}. Copy the link from the walkthrough (\"#v=1&p=X,Y,Z&t=X,Y,Z…\").", link, fault));
    };
    std::map<std::string, std::string> fields;
    const std::string whole = unescaped(link);
    const std::size_t hash = whole.find('#');
    std::string_view rest = std::string_view(whole).substr(hash == std::string::npos ? 0 : hash + 1);
    while (!rest.empty()) {
        const std::string_view field = rest.substr(0, rest.find('&'));
        const std::size_t equals = field.find('=');
        if (equals != std::string_view::npos) fields.emplace(field.substr(0, equals), field.substr(equals + 1));
        rest.remove_prefix(std::min(field.size() + 1, rest.size()));
    }
    const auto field = [&](const char* name) -> std::optional<std::string> {
        const auto found = fields.find(name);
        return found == fields.end() ? std::nullopt : std::optional(found->second);
    };
    if (field("v") && *field("v") != "1") fail("is of another version");
    const std::optional<Vec3f> position = vec3_of(field("p").value_or(""));
    const std::optional<Vec3f> target = vec3_of(field("t").value_or(""));
    if (!position || !target || *position == *target) fail("names no place to look from (p) and to (t)");
    ViewLink view;
    view.position = *position;
    view.target = *target;
    if (const auto picture = field("s")) {
        static const std::map<std::string, PictureKind> kKinds = {{"lit", PictureKind::lit},
                                                                  {"textures", PictureKind::textures},
                                                                  {"light", PictureKind::light},
                                                                  {"illuminance", PictureKind::illuminance},
                                                                  {"sky-view", PictureKind::sky_view}};
        const auto kind = kKinds.find(*picture);
        if (*picture == "layer") {
            view.layer = field("l").value_or("");
            if (view.layer.empty()) fail("shows a layer of a study, but does not say which (l)");
        } else if (kind == kKinds.end()) {
            fail(fmt::format("knows no picture '{}'", *picture));
        } else {
            view.kind = kind->second;
        }
    }
    if (const auto instant = field("i")) {
        view.instant = number_of<std::size_t>(*instant);
        if (!view.instant) fail(fmt::format("the instant '{}' is no number", *instant));
    }
    view.is_between = field("f").has_value();
    if (const auto range = field("fc")) {
        const std::size_t first = range->find(','), second = range->rfind(',');
        const auto low = number_of<double>(std::string_view(*range).substr(0, first));
        const auto high = first < second
                              ? number_of<double>(std::string_view(*range).substr(first + 1, second - first - 1))
                              : std::nullopt;
        const bool is_logarithmic = first < second && range->substr(second + 1) == "log";
        if (!low || !high || !(*low < *high) || (is_logarithmic && !(*low > 0.0)))
            fail(fmt::format("the range '{}' of false colours is not LOW,HIGH,lin or LOW,HIGH,log", *range));
        view.scale = FalseColour{*low, *high, is_logarithmic};
    }
    if (const auto ev = field("ev")) {
        view.ev = number_of<float>(*ev);
        if (!view.ev) fail(fmt::format("the exposure '{}' is no number", *ev));
    }
    if (const auto air = field("a")) {
        if (*air != "0" && *air != "1") fail(fmt::format("the air '{}' is neither 0 nor 1", *air));
        view.has_air = *air == "1";
    }
    if (const auto off = field("off")) {
        for (const std::string_view part : split(*off)) view.off.emplace_back(part);
    }
    if (const auto factors = field("k")) {
        for (const std::string_view entry : split(*factors)) {
            const std::size_t colon = std::min(entry.find(':'), entry.size());
            const auto factor = number_of<float>(entry.substr(std::min(colon + 1, entry.size())));
            if (!factor || *factor < 0.0f) fail(fmt::format("the factor '{}' is not PART:NUMBER", entry));
            view.factors.emplace_back(entry.substr(0, colon), *factor);
        }
    }
    return view;
}

}  // namespace skybake::cli
