#pragma once

#include <string>
#include <string_view>

namespace skybake::io {

/// Text as it may stand in XML, SVG and HTML, in content and in quoted attributes: `&<>"'` are escaped, control
/// characters but tab and line feed, which XML does not know, become blanks.
std::string xml_text(std::string_view text);

}  // namespace skybake::io
