#include "io/epw/read_epw.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>

#include "base/error.h"
#include "base/vec.h"
#include "city/finding_codes.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

// Columns of a row, from 0.
constexpr std::size_t kDryBulb = 6;
constexpr std::size_t kDewPoint = 7;
constexpr std::size_t kPressure = 9;
constexpr std::size_t kGhi = 13;
constexpr std::size_t kDni = 14;
constexpr std::size_t kDhi = 15;
constexpr std::size_t kLeastColumns = 32;  // the last three came with later versions of the format
constexpr std::size_t kMostColumns = 35;
/// Above the sun outside the atmosphere, 1412 W/m² in January, but for clouds' edges that mirror it.
constexpr double kMostIrradiance = 1500.0;
constexpr std::uint64_t kMostBytes = 1ull << 30;

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\"");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\"") - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> fields;
    bool is_quoted = false;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') is_quoted = !is_quoted;
        if (line[i] != ',' || is_quoted) continue;
        fields.push_back(trimmed(line.substr(begin, i - begin)));
        begin = i + 1;
    }
    fields.push_back(trimmed(line.substr(begin)));
    while (fields.size() > 1 && fields.back().empty()) fields.pop_back();  // commas at the end
    return fields;
}

std::optional<double> number_of(std::string_view field) {
    if (!field.empty() && field.front() == '+') field.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// The beginning of a field, fit to be printed.
std::string shown(std::string_view field) {
    std::string text(field.substr(0, 40));
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    }
    return text;
}

/// Takes lines off a text that end in LF, CR LF or CR.
class Lines {
  public:
    explicit Lines(std::string_view text) : rest_(text) {
        if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    }
    bool next(std::string_view& line) {
        if (rest_.empty()) return false;
        const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
        line = rest_.substr(0, end);
        rest_.remove_prefix(end);
        if (rest_.starts_with("\r\n")) {
            rest_.remove_prefix(2);
        } else if (!rest_.empty()) {
            rest_.remove_prefix(1);
        }
        ++number_;
        return true;
    }
    std::uint64_t number() const { return number_; }

  private:
    std::string_view rest_;
    std::uint64_t number_ = 0;
};

/// What is wrong with a row, for its finding.
struct RowFault {
    std::string_view code;
    std::string what;
};

class EpwReader {
  public:
    EpwReader(const std::filesystem::path& path, FindingLog& findings) : findings_(findings) { weather_.file = path; }

    Weather read(std::string_view text) {
        Lines lines(text);
        for (std::string_view line; lines.next(line);) {
            line_ = lines.number();
            if (trimmed(line).empty()) continue;
            const std::vector<std::string_view> fields = fields_of(line);
            const bool is_row = fields[0].find_first_of("0123456789") == 0;
            if (!is_row && !has_rows_) {
                read_header(fields);
            } else {
                begin_rows();
                read_row(fields);
            }
        }
        begin_rows();
        if (weather_.rows.empty()) {
            fail(weather_.rows_left_out == 0
                     ? std::string("there is no row of weather below the header. Load it anew; it may be cut short.")
                     : fmt::format("none of its {} rows can be used; the first: {}. Load it anew.",
                                   weather_.rows_left_out, first_fault_));
        }
        return std::move(weather_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", weather_.file.string(), what));
    }
    std::string here() const { return fmt::format("{}:{}", weather_.name(), line_); }

    void read_header(const std::vector<std::string_view>& fields) {
        if (fields[0] == "LOCATION") {
            read_location(fields);
        } else if (!has_location_) {
            fail(
                fmt::format("line {} begins with '{}', not with LOCATION: this is no EPW weather file. Take the .epw "
                            "of the place.",
                            line_, shown(fields[0])));
        } else if (fields[0] == "DATA PERIODS") {
            const std::optional<double> records = fields.size() > 2 ? number_of(fields[2]) : std::nullopt;
            if (records && *records >= 1.0 && *records <= 60.0 && std::fmod(60.0, *records) == 0.0) {
                weather_.records_per_hour = static_cast<int>(*records);
                has_periods_ = true;
            }
        }
    }

    void read_location(const std::vector<std::string_view>& fields) {
        const auto number = [&](std::size_t column, const char* name, double least, double most) {
            const std::optional<double> value = column < fields.size() ? number_of(fields[column]) : std::nullopt;
            if (!value || *value < least || *value > most) {
                fail(fmt::format(
                    "line {}: the {} in field {} of LOCATION is {}, not a number in {:g}…{:g}. Repair the "
                    "line.",
                    line_, name, column + 1,
                    column < fields.size() ? fmt::format("'{}'", shown(fields[column])) : "missing", least, most));
            }
            return *value;
        };
        WeatherStation& station = weather_.station;
        station.site.latitude_rad = radians_from_degrees(number(6, "latitude", -90.0, 90.0));
        station.site.longitude_rad = radians_from_degrees(number(7, "longitude", -180.0, 180.0));
        station.utc_offset_h = number(8, "time zone", -14.0, 14.0);
        station.site.elevation_m = number(9, "elevation", -1000.0, 9999.9);
        station.city = fields[1];
        station.region = fields[2];
        station.country = fields[3];
        station.source = fields[4];
        station.wmo = fields[5];
        has_location_ = true;
    }

    void begin_rows() {
        if (has_rows_) return;
        has_rows_ = true;
        if (!has_location_) fail("there is no LOCATION line: this is no EPW weather file. Take the .epw of the place.");
        if (!has_periods_) {
            findings_.add(make_finding("SB715", weather_.name(),
                                       "the line DATA PERIODS is missing or does not state the records an hour; one is "
                                       "assumed."));
        }
    }

    void read_row(const std::vector<std::string_view>& fields) {
        WeatherRow row;
        row.line = line_;
        if (const std::optional<RowFault> fault = fault_of(fields, row)) {
            if (weather_.rows_left_out++ == 0) first_fault_ = fmt::format("line {}, {}", line_, fault->what);
            findings_.add(make_finding(fault->code, here(), fault->what + "; the row is left out."));
            return;
        }
        weather_.rows.push_back(row);
    }

    /// Fills `row` from the fields, or says why that cannot be.
    std::optional<RowFault> fault_of(const std::vector<std::string_view>& fields, WeatherRow& row) {
        if (fields.size() < kLeastColumns || fields.size() > kMostColumns) {
            return RowFault{"SB701", fmt::format("the row has {} fields, not {} to {}", fields.size(), kLeastColumns,
                                                 kMostColumns)};
        }
        constexpr const char* kDateNames[] = {"year", "month", "day", "hour", "minute"};
        constexpr int kLeast[] = {1, 1, 1, 0, 0};
        constexpr int kMost[] = {6000, 12, 31, 24, 60};
        int date[5];
        for (std::size_t i = 0; i < 5; ++i) {
            const std::optional<double> value = number_of(fields[i]);
            if (!value || *value != std::floor(*value) || *value < kLeast[i] || *value > kMost[i]) {
                return RowFault{"SB701", fmt::format("the {} is '{}', not a whole number in {}…{}", kDateNames[i],
                                                     shown(fields[i]), kLeast[i], kMost[i])};
            }
            date[i] = static_cast<int>(*value);
        }
        row.year = date[0];
        row.month = date[1];
        row.day = date[2];
        try {
            utc_midnight(row.year, row.month, row.day);
        } catch (const InputError&) {
            return RowFault{"SB701", fmt::format("there is no day {:04}-{:02}-{:02}", row.year, row.month, row.day)};
        }
        // Files with one record an hour write 0, 60 or anything else for the minute of a whole hour.
        row.label_h = weather_.records_per_hour == 1 ? date[3] : date[3] - 1 + date[4] / 60.0;

        std::optional<RowFault> fault;
        const auto value = [&](std::size_t column, const char* name, double missing_from) -> std::optional<double> {
            if (fields[column].empty()) return std::nullopt;
            const std::optional<double> number = number_of(fields[column]);
            if (!number && !fault) {
                fault = RowFault{"SB701", fmt::format("the {} in field {} is '{}', which is no number", name,
                                                      column + 1, shown(fields[column]))};
            }
            return number && *number < missing_from ? number : std::nullopt;
        };
        const auto irradiance = [&](std::size_t column, const char* name) {
            const std::optional<double> watts = value(column, name, 9999.0);
            if (watts && !(*watts >= 0.0 && *watts <= kMostIrradiance) && !fault) {
                fault = RowFault{"SB702", fmt::format("the {} in field {} is {:g} W/m², outside 0…{:g}", name,
                                                      column + 1, *watts, kMostIrradiance)};
            }
            return watts;
        };
        row.dry_bulb_c = value(kDryBulb, "dry bulb temperature", 99.9);
        row.dew_point_c = value(kDewPoint, "dew point", 99.9);
        row.pressure_pa = value(kPressure, "pressure", 999999.0);
        row.ghi = irradiance(kGhi, "global horizontal radiation");
        row.dni = irradiance(kDni, "direct normal radiation");
        row.dhi = irradiance(kDhi, "diffuse horizontal radiation");
        if (!fault && !seen_.insert({row.year, row.month, row.day, row.label_h}).second) {
            fault = RowFault{"SB703", fmt::format("{:04}-{:02}-{:02} hour {:g} stands in the file twice", row.year,
                                                  row.month, row.day, row.label_h)};
        }
        return fault;
    }

    FindingLog& findings_;
    Weather weather_;
    std::uint64_t line_ = 0;
    bool has_location_ = false;
    bool has_periods_ = false;
    bool has_rows_ = false;
    std::string first_fault_;
    std::set<std::tuple<int, int, int, double>> seen_;
};

}  // namespace

Weather read_epw(const std::filesystem::path& path, FindingLog& findings) {
    const std::vector<std::uint8_t> bytes = read_file(path, kMostBytes);
    return EpwReader(path, findings).read({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace skybake::io
