#include "io/file/csv_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace skybake::io {
namespace {

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

CsvReader::CsvReader(std::string_view text, const std::string& name) : text_(text), name_(name) {
    if (text_.substr(0, 3) == "\xef\xbb\xbf") at_ = 3;  // the byte order mark that spreadsheets write
}

bool CsvReader::next(std::vector<std::string>& fields) {
    while (at_ < text_.size()) {
        record_line_ = line_;
        fields.clear();
        read_record(fields);
        if (fields.size() > 1 || !fields[0].empty()) return true;
    }
    return false;
}
void CsvReader::fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", name_, record_line_, what));
}
void CsvReader::read_record(std::vector<std::string>& fields) {
    for (;;) {
        fields.push_back(read_field());
        if (at_ >= text_.size()) return;
        const char end = text_[at_++];
        if (end == ',') continue;
        ++line_;
        return;
    }
}
/// Up to a comma or the line's end, which is left standing.
std::string CsvReader::read_field() {
    const std::size_t start = text_.find_first_not_of(" \t", at_);
    if (start == std::string_view::npos || text_[start] != '"') {
        const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
        const std::string_view field = trimmed(text_.substr(at_, end - at_));
        at_ = end;
        return std::string(field);
    }
    std::string field;
    for (at_ = start + 1; at_ < text_.size(); ++at_) {
        if (text_[at_] == '"') {
            if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') break;
            ++at_;
        }
        if (text_[at_] == '\n') ++line_;
        field += text_[at_];
    }
    if (at_ >= text_.size()) fail("a quoted field has no closing quote.");
    const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
    if (!trimmed(text_.substr(at_ + 1, end - at_ - 1)).empty())
        fail("text stands behind the closing quote of a field.");
    at_ = end;
    return field;
}
}  // namespace skybake::io
