// JSON as text: cutting a large document into pieces without parsing it, and finding where a broken one breaks.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace skybake::io {

/// A text in memory behind which enough readable bytes follow for simdjson.
class PaddedText {
  public:
    explicit PaddedText(std::string text);
    std::string_view view() const { return std::string_view(text_).substr(begin_, size_); }

  private:
    std::string text_;
    std::size_t begin_ = 0;  // behind a byte order mark
    std::size_t size_ = 0;
};

/// Calls `member(key, value)` for each member of the JSON object that `text` holds, in order, doubles included; key
/// without quotes and escapes resolved, value as its raw text. Values are only skipped over, not validated. False when
/// the text is no such object. Linear in the length of the text, no recursion.
bool for_each_member(std::string_view text,
                     const std::function<void(std::string_view key, std::string_view value)>& member);

/// Calls `block(elements)` with the raw text of runs of whole elements of the JSON array that `text` holds
/// ("[1,2],[3,4]", without the outer brackets), each about `block_bytes` long. False when the text is no array.
bool for_each_block(std::string_view text, std::size_t block_bytes,
                    const std::function<void(std::string_view elements)>& block);

/// The length of the JSON object or array that begins at the first character of `text`, or npos when it does not end in
/// it.
std::size_t length_of_value(std::string_view text);

/// Where and why the text is not JSON: "line 3, column 17: syntax error …", or empty when it is. Lines and columns
/// (bytes) count from 1, the first line as `first_line`.
std::string json_fault(std::string_view text, std::size_t first_line = 1);

}  // namespace skybake::io
