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
#include "io/file/csv_reader.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

constexpr std::array<std::string_view, 7> kColumns = {"id", "x", "y", "z", "nx", "ny", "nz"};

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
