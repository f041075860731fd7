// HTML that cannot be broken by what it shows: all text and attributes are escaped.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace skybake::io {

/// Writes elements one after the other; each open() asks for a close(). Tag and attribute names are the program's own,
/// values and text may be anybody's.
class Html {
  public:
    using Attributes = std::initializer_list<std::pair<std::string_view, std::string_view>>;

    Html& open(std::string_view tag, Attributes attributes = {});
    /// Closes the innermost open element, which must be `tag`.
    Html& close(std::string_view tag);
    Html& text(std::string_view text);
    /// The element with nothing but text in it.
    Html& element(std::string_view tag, std::string_view text, Attributes attributes = {});
    /// Markup that is already safe: pictures of this program's making.
    Html& markup(std::string_view markup);

    struct Cell {
        Cell(std::string content) : text(std::move(content)) {}
        Cell(const char* content) : text(content) {}
        Cell(std::string content, const char* css_class) : text(std::move(content)), style(css_class) {}
        std::string text;
        const char* style = nullptr;  // its class; without one "number" or "words", by what it holds
    };
    /// A table; its head is repeated on each printed page.
    Html& table(const std::vector<std::string>& head, const std::vector<std::vector<Cell>>& rows);

    /// All of it. Every element must be closed.
    const std::string& str() const;

  private:
    std::string out_;
    std::vector<std::string> open_;
};

/// "data:TYPE;base64,…".
std::string data_uri(std::string_view type, std::span<const std::uint8_t> bytes);

}  // namespace skybake::io
