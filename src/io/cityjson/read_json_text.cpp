#include "io/cityjson/read_json_text.h"

#include <fmt/format.h>
#include <simdjson.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

namespace skybake::io {
namespace {

constexpr std::size_t kNone = std::string_view::npos;

std::size_t skip_space(std::string_view text, std::size_t at) {
    while (at < text.size() && (text[at] == ' ' || text[at] == '\n' || text[at] == '\r' || text[at] == '\t')) ++at;
    return at;
}

/// The place behind the string that begins at `at`, or npos.
std::size_t skip_string(std::string_view text, std::size_t at) {
    for (++at; at < text.size(); ++at) {
        const void* quote = std::memchr(text.data() + at, '"', text.size() - at);
        if (!quote) return kNone;
        at = static_cast<std::size_t>(static_cast<const char*>(quote) - text.data());
        std::size_t slashes = 0;
        while (text[at - 1 - slashes] == '\\') ++slashes;  // ends at the opening quote at the latest
        if (slashes % 2 == 0) return at + 1;
    }
    return kNone;
}

/// The place behind the value that begins at `at`, or npos.
std::size_t skip_value(std::string_view text, std::size_t at) {
    if (at >= text.size()) return kNone;
    if (text[at] == '"') return skip_string(text, at);
    if (text[at] != '{' && text[at] != '[') {
        const std::size_t begin = at;
        while (at < text.size() && std::strchr(",]} \n\r\t\"[{:", text[at]) == nullptr) ++at;
        return at == begin ? kNone : at;
    }
    std::size_t depth = 0;
    while (at < text.size()) {
        switch (text[at]) {
            case '"':
                at = skip_string(text, at);
                if (at == kNone) return kNone;
                continue;
            case '{':
            case '[':
                ++depth;
                break;
            case '}':
            case ']':
                if (--depth == 0) return at + 1;
                break;
            default:
                break;
        }
        ++at;
    }
    return kNone;
}

/// The text of a key with its escapes resolved.
std::string unescape(std::string_view raw) {
    const std::string quoted = fmt::format("[\"{}\"]", raw);
    simdjson::dom::parser parser;
    simdjson::dom::element element;
    if (parser.parse(quoted).get(element) != simdjson::SUCCESS) return std::string(raw);
    const std::string_view value = element.at(0).get_string().value();
    return std::string(value);
}

/// Swallows all values and keeps only where the parser stumbled.
class FaultFinder final : public nlohmann::json_sax<nlohmann::json> {
  public:
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return true; }
    bool key(string_t&) override { return true; }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
        offset = position == 0 ? 0 : position - 1;
        what = error.what();
        return false;
    }
    std::size_t offset = kNone;
    std::string what;
};

}  // namespace

PaddedText::PaddedText(std::string text) : text_(std::move(text)), size_(text_.size()) {
    if (std::string_view(text_).substr(0, 3) == "\xEF\xBB\xBF") {
        begin_ = 3;
        size_ -= 3;
    }
    text_.append(simdjson::SIMDJSON_PADDING, ' ');
}

bool for_each_member(std::string_view text, const std::function<void(std::string_view, std::string_view)>& member) {
    std::size_t at = skip_space(text, 0);
    if (at >= text.size() || text[at] != '{') return false;
    at = skip_space(text, at + 1);
    if (at < text.size() && text[at] == '}') return true;
    while (at < text.size() && text[at] == '"') {
        const std::size_t key_end = skip_string(text, at);
        if (key_end == kNone) return false;
        const std::string_view key = text.substr(at + 1, key_end - at - 2);
        at = skip_space(text, key_end);
        if (at >= text.size() || text[at] != ':') return false;
        at = skip_space(text, at + 1);
        const std::size_t value_end = skip_value(text, at);
        if (value_end == kNone) return false;
        const std::string_view value = text.substr(at, value_end - at);
        if (key.find('\\') == kNone) {
            member(key, value);
        } else {
            member(unescape(key), value);
        }
        at = skip_space(text, value_end);
        if (at < text.size() && text[at] == '}') return true;
        if (at >= text.size() || text[at] != ',') return false;
        at = skip_space(text, at + 1);
    }
    return false;
}

bool for_each_block(std::string_view text, std::size_t block_bytes,
                    const std::function<void(std::string_view)>& block) {
    std::size_t at = skip_space(text, 0);
    if (at >= text.size() || text[at] != '[') return false;
    at = skip_space(text, at + 1);
    if (at < text.size() && text[at] == ']') return true;
    std::size_t begin = at;
    while (at < text.size()) {
        const std::size_t end = skip_value(text, at);
        if (end == kNone) return false;
        at = skip_space(text, end);
        if (at >= text.size()) return false;
        const bool is_last = text[at] == ']';
        if (!is_last && text[at] != ',') return false;
        if (is_last || end - begin >= block_bytes) {
            block(text.substr(begin, end - begin));
            begin = skip_space(text, at + 1);
        }
        if (is_last) return true;
        at = skip_space(text, at + 1);
    }
    return false;
}

std::size_t length_of_value(std::string_view text) {
    if (text.empty() || (text[0] != '{' && text[0] != '[')) return kNone;
    return skip_value(text, 0);
}

std::string json_fault(std::string_view text, std::size_t first_line) {
    FaultFinder finder;
    if (nlohmann::json::sax_parse(text.begin(), text.end(), &finder)) return "";
    const std::size_t offset = std::min(finder.offset, text.size());
    const std::string_view before = text.substr(0, offset);
    const std::size_t line = first_line + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
    const std::size_t line_begin = before.rfind('\n') == kNone ? 0 : before.rfind('\n') + 1;
    // The parser's own words begin with its own name and place; what follows "syntax error " is for humans.
    const std::size_t words = finder.what.find("syntax error ");
    std::string reason = words == kNone ? finder.what : finder.what.substr(words);
    if (const std::size_t colon = reason.find("; last read"); colon != kNone && reason.size() > 200)
        reason.resize(colon);
    return fmt::format("line {}, column {}: {}", line, offset - line_begin + 1, reason);
}

}  // namespace skybake::io
