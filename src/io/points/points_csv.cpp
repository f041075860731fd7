#include "io/points/points_csv.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>

#include "base/check.h"
#include "base/error.h"
#include "io/file/csv_field.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

constexpr std::array<std::string_view, 7> kColumns = {"id", "x", "y", "z", "nx", "ny", "nz"};

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Walks through the text record by record; a quoted field may hold commas, doubled quotes and line ends (RFC 4180).
class CsvReader {
  public:
    CsvReader(std::string_view text, const std::string& name) : text_(text), name_(name) {
        if (text_.substr(0, 3) == "\xef\xbb\xbf") at_ = 3;  // the byte order mark that spreadsheets write
    }

    /// False at the end. Lines that are empty are passed over.
    bool next(std::vector<std::string>& fields) {
        while (at_ < text_.size()) {
            record_line_ = line_;
            fields.clear();
            read_record(fields);
            if (fields.size() > 1 || !fields[0].empty()) return true;
        }
        return false;
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: line {}: {}", name_, record_line_, what));
    }

  private:
    void read_record(std::vector<std::string>& fields) {
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
    std::string read_field() {
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

    std::string_view text_;
    const std::string& name_;
    std::size_t at_ = 0;
    std::uint64_t line_ = 1;
    std::uint64_t record_line_ = 1;
};

double number(const CsvReader& csv, const std::vector<std::string>& fields, std::size_t column) {
    const std::string& field = fields[column];
    const char* first = field.data();
    if (*first == '+') ++first;
    double value = 0.0;
    const auto [end, error] = std::from_chars(first, field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) {
        csv.fail(
            fmt::format("'{}' in column {} is no number. Write it like 12.5, with a point.", field, kColumns[column]));
    }
    if (!std::isfinite(value)) csv.fail(fmt::format("'{}' in column {} is not finite.", field, kColumns[column]));
    return value;
}

}  // namespace

std::vector<ProbePoint> read_points(const std::filesystem::path& path) {
    const std::vector<std::uint8_t> bytes = read_file(path);
    const std::string name = path.string();
    CsvReader csv(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name);
    std::vector<std::string> fields;
    if (!csv.next(fields))
        throw InputError(fmt::format("{}: is empty. Its first line must be {}.", name, fmt::join(kColumns, ",")));
    for (std::size_t c = 0; c < kColumns.size(); ++c) {
        if (c >= fields.size() || fields[c] != kColumns[c]) {
            csv.fail(fmt::format("column {} must be '{}'. The first line must begin with {}.", c + 1, kColumns[c],
                                 fmt::join(kColumns, ",")));
        }
    }
    std::vector<ProbePoint> points;
    while (csv.next(fields)) {
        if (fields.size() < kColumns.size())
            csv.fail(fmt::format("has {} fields, not the {} of {}.", fields.size(), kColumns.size(),
                                 fmt::join(kColumns, ",")));
        ProbePoint point;
        point.id = fields[0];
        point.position = {number(csv, fields, 1), number(csv, fields, 2), number(csv, fields, 3)};
        point.normal = {number(csv, fields, 4), number(csv, fields, 5), number(csv, fields, 6)};
        // By the largest component first, so that neither huge nor tiny normals overflow or vanish.
        const double largest = std::max({std::abs(point.normal.x), std::abs(point.normal.y), std::abs(point.normal.z)});
        if (largest == 0.0) csv.fail(fmt::format("the normal of point '{}' has no length.", point.id));
        point.normal = glm::normalize(point.normal / largest);
        points.push_back(point);
    }
    return points;
}

std::string probe_csv(std::span<const ProbePoint> points, std::span<const ProbeLight> light) {
    SKYBAKE_CHECK_EQ(points.size(), light.size());
    std::string csv =
        "id,sun_lx,sky_lx,indirect_lx,total_lx,total_r,total_g,total_b,sun_visible,sky_view_factor,lamps_lx,"
        "indirect_error_lx\n";
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ProbeLight& l = light[i];
        const auto f = [](double value) { return static_cast<float>(value); };
        fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_field(points[i].id),
                       f(l.sun_lx), f(l.sky_lx), f(l.indirect_lx), luminance(l.total), l.total.x, l.total.y, l.total.z,
                       f(l.sun_visible), f(l.sky_view_factor), f(l.lamps_lx), f(l.indirect_error_lx));
    }
    return csv;
}

void write_probe_csv(const std::filesystem::path& path, std::span<const ProbePoint> points,
                     std::span<const ProbeLight> light) {
    const std::string csv = probe_csv(points, light);
    FileReplacement file(path);
    file.write(csv);
    file.commit();
}

}  // namespace skybake::io
