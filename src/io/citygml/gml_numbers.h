// Numbers in GML: lists divided by white space, positions of two or three of them.
#pragma once

#include <charconv>
#include <string_view>
#include <vector>

namespace skybake::io {

/// Appends the numbers of a list divided by white space (and by `also`, where a list uses another mark too). False when
/// something else stands there.
inline bool read_numbers(std::string_view text, std::vector<double>& into, char also = ' ') {
    const auto is_blank = [&](char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == also; };
    const char* at = text.data();
    const char* const end = at + text.size();
    for (;;) {
        while (at != end && is_blank(*at)) ++at;
        if (at == end) return true;
        if (*at == '+') ++at;  // from_chars knows no plus
        double value = 0.0;
        const auto parsed = std::from_chars(at, end, value);
        if (parsed.ec != std::errc() || (parsed.ptr != end && !is_blank(*parsed.ptr))) return false;
        into.push_back(value);
        at = parsed.ptr;
    }
}

}  // namespace skybake::io
