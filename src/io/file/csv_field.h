#pragma once

#include <string>
#include <string_view>

namespace skybake::io {

/// A field of a CSV line: in quotes where it holds a comma, a quote or a line break (RFC 4180, §2).
std::string csv_field(std::string_view text);

}  // namespace skybake::io
