// Words and numbers in the lines of OBJ and MTL files.
#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace skybake::io {

inline std::string_view trim(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\n";
    const std::size_t begin = text.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlank) + 1 - begin);
}

/// Takes the first word off `text`; empty at the end.
inline std::string_view next_word(std::string_view& text) {
    text = trim(text);
    const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    return word;
}

inline std::optional<double> number_of(std::string_view word) {
    if (word.substr(0, 1) == "+") word.remove_prefix(1);
    double value = 0.0;
    const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
    return parsed.ec == std::errc() && parsed.ptr == word.data() + word.size() && !word.empty() ? std::optional(value)
                                                                                                : std::nullopt;
}

}  // namespace skybake::io
