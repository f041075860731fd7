#include "sky/weather.h"

#include <date/date.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "base/vec.h"
#include "sky/solar_position.h"

namespace skybake {

namespace {

constexpr double kHourMs = 3'600'000.0;
constexpr double kDayMs = 24.0 * kHourMs;

// Model years keep their sums to 2 W/m² on average and have a confidence of 0.8 and more (docs/validation.md); a clear
// year with 30 W/m² of noise on GHI and on DHI has 0.17 and is still right to ten minutes (weather_test).
constexpr double kLeastConfidence = 0.1;
constexpr std::size_t kLeastSunnyRows = 48;
constexpr double kSunnyDni = 50.0;

/// Declination and hour angle of a row's sun at its label, and how they go on from there.
struct RowSun {
    double declination_rad;
    double declination_rate;  // rad/h
    double hour_angle_rad;
    double hour_angle_rate;  // rad/h

    /// Of the geocentric elevation; within half a day of the label right to 0.002°.
    double sine_of_elevation(double offset_h, double latitude_rad) const {
        const double declination = declination_rad + declination_rate * offset_h;
        const double hour_angle = hour_angle_rad + hour_angle_rate * offset_h;
        return std::sin(latitude_rad) * std::sin(declination) +
               std::cos(latitude_rad) * std::cos(declination) * std::cos(hour_angle);
    }
};

/// The suns of many rows, linear between the midnights (UTC) of their days.
class RowSuns {
  public:
    explicit RowSuns(const Weather& weather) : weather_(weather) {}

    RowSun of(const WeatherRow& row) {
        const double days = seconds_since_1970(label_time(weather_, row)) / 86400.0;
        const double midnight = std::floor(days);
        const Midnight& now = at(static_cast<std::int64_t>(midnight));
        const Midnight& next = at(static_cast<std::int64_t>(midnight) + 1);
        const double share = days - midnight;
        const double equation =
            now.equation_of_time_rad + share * (next.equation_of_time_rad - now.equation_of_time_rad);
        return {now.declination_rad + share * (next.declination_rad - now.declination_rad),
                (next.declination_rad - now.declination_rad) / 24.0,
                2.0 * kPi * (share - 0.5) + weather_.station.site.longitude_rad + equation,
                (2.0 * kPi + next.equation_of_time_rad - now.equation_of_time_rad) / 24.0};
    }
    double sine_at_middle(const WeatherRow& row) {
        return of(row).sine_of_elevation(weather_.centre.offset_h, weather_.station.site.latitude_rad);
    }

  private:
    struct Midnight {
        double declination_rad;
        double equation_of_time_rad;
    };
    const Midnight& at(std::int64_t day) {
        const auto [entry, is_new] = midnights_.try_emplace(day);
        if (is_new) {
            const SolarPosition sun = solar_position(UtcTime{day * 86'400'000}, weather_.station.site);
            entry->second = {sun.declination_rad, sun.equation_of_time_min * 2.0 * kPi / 1440.0};
        }
        return entry->second;
    }

    const Weather& weather_;
    std::map<std::int64_t, Midnight> midnights_;
};

/// A row of the day with all three irradiances.
struct SunnyRow {
    double ghi;
    double dni;
    double dhi;
    RowSun sun;
};

std::vector<SunnyRow> day_rows(const Weather& weather) {
    std::vector<SunnyRow> day;
    RowSuns suns(weather);
    for (const WeatherRow& row : weather.rows) {
        if (!row.ghi || !row.dni || !row.dhi || *row.ghi + *row.dni + *row.dhi <= 0.0) continue;
        day.push_back({*row.ghi, *row.dni, *row.dhi, suns.of(row)});
    }
    return day;
}

/// Mean of |GHI − DHI − DNI sin h| in W m⁻².
double residual_at(const std::vector<SunnyRow>& day, double offset_h, double latitude_rad) {
    double sum = 0.0;
    for (const SunnyRow& row : day) {
        const double sine = std::max(0.0, row.sun.sine_of_elevation(offset_h, latitude_rad));
        sum += std::abs(row.ghi - row.dhi - row.dni * sine);
    }
    return day.empty() ? 0.0 : sum / static_cast<double>(day.size());
}

/// The integer number of minutes of the least residual: every 15 minutes of a day, then about the best every minute.
int best_minute(const std::vector<SunnyRow>& day, double latitude_rad) {
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](int minute) {
        const double residual = residual_at(day, minute / 60.0, latitude_rad);
        if (residual < least) {
            least = residual;
            best = minute;
        }
    };
    for (int minute = -720; minute < 720; minute += 15) look(minute);
    const int middle = best;
    for (int minute = middle - 14; minute <= middle + 14; ++minute) look(minute);
    return best;
}

HourCentre centre_of(const std::vector<SunnyRow>& day, const Weather& weather) {
    const double latitude = weather.station.site.latitude_rad;
    HourCentre centre;
    centre.offset_h = -0.5 * weather.interval_h();
    centre.standard_residual_w_m2 = residual_at(day, centre.offset_h, latitude);
    centre.residual_w_m2 = centre.standard_residual_w_m2;
    const auto sunny = std::count_if(day.begin(), day.end(), [](const SunnyRow& row) { return row.dni >= kSunnyDni; });
    if (static_cast<std::size_t>(sunny) < kLeastSunnyRows) return centre;

    int minute = best_minute(day, latitude);
    const int quarter = 15 * static_cast<int>(std::lround(minute / 15.0));
    if (std::abs(minute - quarter) <= 3) minute = quarter;
    const double best_h = minute / 60.0;
    const double residual = residual_at(day, best_h, latitude);
    const double beside = 0.5 * (residual_at(day, best_h - 0.5, latitude) + residual_at(day, best_h + 0.5, latitude));
    centre.confidence = beside > 0.0 ? std::max(0.0, 1.0 - residual / beside) : 0.0;
    if (centre.confidence < kLeastConfidence) return centre;
    centre.offset_h = best_h;
    centre.is_detected = true;
    centre.residual_w_m2 = residual;
    return centre;
}

std::string hours_text(double hours) {
    return fmt::format("{}{:g} h", hours < 0.0 ? "−" : "+", std::abs(hours));
}

std::string place_of(const Weather& weather, const WeatherRow& row) {
    return fmt::format("{}:{}", weather.name(), row.line);
}

using Columns = std::array<std::optional<double> WeatherRow::*, 3>;
constexpr Columns kColumns = {&WeatherRow::ghi, &WeatherRow::dni, &WeatherRow::dhi};
constexpr std::array<const char*, 3> kColumnNames = {"global horizontal", "direct normal", "diffuse horizontal"};

/// Columns exchanged in pairs, when that alone makes the radiation add up.
void put_columns_right(Weather& weather, FindingLog& findings) {
    const std::vector<SunnyRow> day = day_rows(weather);
    const double given = centre_of(day, weather).residual_w_m2;
    double mean_ghi = 0.0;
    for (const SunnyRow& row : day) mean_ghi += row.ghi / static_cast<double>(day.size());
    // A fifth of the day's mean is far more than measurement and averaging over an hour leave, which is a few per cent.
    if (day.size() < kLeastSunnyRows || given < 0.2 * mean_ghi) return;
    for (const auto& [first, second] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
        Weather turned = weather;
        for (WeatherRow& row : turned.rows) std::swap(row.*kColumns[first], row.*kColumns[second]);
        const HourCentre centre = find_hour_centre(turned);
        if (!centre.is_detected || centre.residual_w_m2 > 0.2 * given) continue;
        findings.add(
            {"SB708", Severity::warning, weather.name(),
             fmt::format("{} and {} radiation stand in each other's column: exchanged, the three add up to {:.1f} "
                         "W/m² on average, as given to {:.1f} W/m². They were exchanged.",
                         kColumnNames[first], kColumnNames[second], centre.residual_w_m2, given),
             "Nothing to do: they were exchanged. Its writer should keep to the order global, direct, diffuse."});
        weather = std::move(turned);
        return;
    }
}

void tell_centre(const Weather& weather, FindingLog& findings) {
    const HourCentre& centre = weather.centre;
    const double standard_h = -0.5 * weather.interval_h();
    if (!centre.is_detected) {
        findings.add({"SB710", Severity::info, weather.name(),
                      fmt::format("too little sunshine, or radiation that does not add up, to find the middle of the "
                                  "hours: it is taken as label {}, as the format says.",
                                  hours_text(standard_h)),
                      "Nothing to do, unless shadows of the morning and the evening look exchanged."});
    } else if (std::abs(centre.offset_h - standard_h) > 0.1 * weather.interval_h()) {
        findings.add(
            {"SB709", Severity::warning, weather.name(),
             fmt::format("the middle of the hours is label {}, not label {} as the format says: there GHI, DHI and "
                         "DNI differ by {:.1f} W/m² on average, else by {:.1f} W/m². It is used.",
                         hours_text(centre.offset_h), hours_text(standard_h), centre.residual_w_m2,
                         centre.standard_residual_w_m2),
             "Nothing to do: the sun stands where the radiation says."});
    }
}

/// What the closure GHI = DHI + DNI sin h leaves: one missing value is filled, disagreement told.
void close_row(const Weather& weather, WeatherRow& row, RowSuns& suns, FindingLog& findings) {
    const int known = row.ghi.has_value() + row.dni.has_value() + row.dhi.has_value();
    if (known < 2) {
        findings.add({"SB706", Severity::warning, place_of(weather, row),
                      "of global, direct and diffuse radiation fewer than two are given: this hour has no light.",
                      "Choose another hour, or fill the row."});
        return;
    }
    if (known == 3 && *row.ghi + *row.dni + *row.dhi <= 0.0) return;
    const double sine = std::max(0.0, suns.sine_at_middle(row));
    if (known == 3) {
        const double sum = *row.dhi + *row.dni * sine;
        // Averages over an hour in which the sun rises or sets differ by some 30 W/m² from products of averages.
        if (std::abs(*row.ghi - sum) <= std::max(50.0, 0.15 * *row.ghi)) return;
        findings.add(
            {"SB707", Severity::warning, place_of(weather, row),
             fmt::format("GHI is {:.0f} W/m², but DHI + DNI sin h is {:.0f} W/m². Direct and diffuse are used.",
                         *row.ghi, sum),
             "Take another source for such hours where they matter."});
        return;
    }
    const char* filled = "";
    if (!row.ghi) {
        row.ghi = *row.dhi + *row.dni * sine;
        filled = kColumnNames[0];
    } else if (!row.dni) {
        // Below 3° a small difference would become a huge beam.
        row.dni = sine > 0.05 ? std::clamp((*row.ghi - *row.dhi) / sine, 0.0, 1400.0) : 0.0;
        filled = kColumnNames[1];
    } else {
        row.dhi = std::max(0.0, *row.ghi - *row.dni * sine);
        filled = kColumnNames[2];
    }
    findings.add({"SB705", Severity::info, place_of(weather, row),
                  fmt::format("the {} radiation is missing; it follows from the two others.", filled),
                  "Nothing to do."});
}

/// Milliseconds since the beginning of the file's own calendar year, of 365 or 366 days.
struct Calendar {
    bool has_leap_day;
    double length_ms() const { return (has_leap_day ? 366.0 : 365.0) * kDayMs; }
    double since_new_year_ms(int month, int day, double hour) const {
        constexpr int kDaysBefore[] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
        const int leap = has_leap_day && month > 2 ? 1 : 0;
        return (kDaysBefore[month - 1] + leap + day - 1) * kDayMs + hour * kHourMs;
    }
};

bool holds_an_hour_twice(const std::vector<WeatherRow>& rows) {
    std::set<std::tuple<int, int, double>> seen;
    return std::any_of(rows.begin(), rows.end(), [&](const WeatherRow& row) {
        return !seen.insert({row.month, row.day, row.label_h}).second;
    });
}

double floor_mod(double a, double b) {
    const double rest = std::fmod(a, b);
    return rest < 0.0 ? rest + b : rest;
}

}  // namespace

UtcTime label_time(const Weather& weather, const WeatherRow& row) {
    return UtcTime{utc_midnight(row.year, row.month, row.day).milliseconds +
                   std::llround((row.label_h - weather.station.utc_offset_h) * kHourMs)};
}

HourCentre find_hour_centre(const Weather& weather) {
    return centre_of(day_rows(weather), weather);
}

void settle_weather(Weather& weather, FindingLog& findings) {
    weather.has_leap_day = std::any_of(weather.rows.begin(), weather.rows.end(),
                                       [](const WeatherRow& row) { return row.month == 2 && row.day == 29; });
    weather.spans_years = holds_an_hour_twice(weather.rows);

    const double solar_offset_h = degrees_from_radians(weather.station.site.longitude_rad) / 15.0;
    const double apart_h = std::abs(std::remainder(weather.station.utc_offset_h - solar_offset_h, 24.0));
    // The widest clock in use, that of western China, is three hours off.
    if (apart_h > 3.5) {
        findings.add({"SB714", Severity::warning, weather.name(),
                      fmt::format("the time zone {} is {:.1f} hours from the sun's time at longitude {:g}°.",
                                  hours_text(weather.station.utc_offset_h), apart_h,
                                  degrees_from_radians(weather.station.site.longitude_rad)),
                      "Check longitude (east positive) and time zone in the LOCATION line."});
    }
    if (const std::uint64_t expected = expected_rows(weather); weather.rows.size() < expected) {
        findings.add({"SB704", Severity::warning, weather.name(),
                      fmt::format("{} of {} records are missing: they have no light, and sums lack them.",
                                  expected - weather.rows.size(), expected),
                      "Take a whole file where sums count."});
    }
    put_columns_right(weather, findings);
    weather.centre = find_hour_centre(weather);
    tell_centre(weather, findings);
    RowSuns suns(weather);
    for (WeatherRow& row : weather.rows) close_row(weather, row, suns, findings);
}

WeatherSums sums_of(const Weather& weather) {
    WeatherSums sums;
    for (const WeatherRow& row : weather.rows) {
        sums.ghi += row.ghi.value_or(0.0);
        sums.dni += row.dni.value_or(0.0);
        sums.dhi += row.dhi.value_or(0.0);
    }
    const double kwh = 1e-3 * weather.interval_h();
    return {sums.ghi * kwh, sums.dni * kwh, sums.dhi * kwh};
}

std::vector<int> years_of(const Weather& weather) {
    std::set<int> years;
    for (const WeatherRow& row : weather.rows) years.insert(row.year);
    return {years.begin(), years.end()};
}

std::uint64_t expected_rows(const Weather& weather) {
    if (!weather.spans_years) return (weather.has_leap_day ? 8784u : 8760u) * weather.records_per_hour;
    const auto [first, last] = std::minmax_element(
        weather.rows.begin(), weather.rows.end(),
        [&](const WeatherRow& a, const WeatherRow& b) { return label_time(weather, a) < label_time(weather, b); });
    const double span_ms =
        static_cast<double>(label_time(weather, *last).milliseconds - label_time(weather, *first).milliseconds);
    return static_cast<std::uint64_t>(std::llround(span_ms / (kHourMs * weather.interval_h()))) + 1;
}

std::optional<WeatherHour> weather_at(const Weather& weather, UtcTime instant) {
    const bool is_of_one_year = !weather.spans_years;
    const Calendar calendar{weather.has_leap_day};
    const double interval_ms = weather.interval_h() * kHourMs;

    const double local_ms = static_cast<double>(instant.milliseconds) + weather.station.utc_offset_h * kHourMs;
    const date::sys_days day{date::days(static_cast<int>(std::floor(local_ms / kDayMs)))};
    const date::year_month_day ymd(day);
    int month = static_cast<int>(static_cast<unsigned>(ymd.month()));
    int day_of_month = static_cast<int>(static_cast<unsigned>(ymd.day()));
    WeatherHour hour;
    if (is_of_one_year && !calendar.has_leap_day && month == 2 && day_of_month == 29) {
        day_of_month = 28;
        hour.is_leap_day_replaced = true;
    }
    const double asked_ms = is_of_one_year
                                ? calendar.since_new_year_ms(month, day_of_month, floor_mod(local_ms, kDayMs) / kHourMs)
                                : static_cast<double>(instant.milliseconds);

    const WeatherRow* before = nullptr;
    const WeatherRow* after = nullptr;
    double before_ms = 2.0 * interval_ms;  // how far away it is; farther rows say nothing of the instant
    double after_ms = 2.0 * interval_ms;
    for (const WeatherRow& row : weather.rows) {
        if (!row.dni || !row.dhi) continue;
        double since_ms = 0.0;  // from the row's middle to the instant
        if (is_of_one_year) {
            since_ms = asked_ms - calendar.since_new_year_ms(row.month, row.day, row.label_h + weather.centre.offset_h);
            since_ms =
                floor_mod(since_ms + 0.5 * calendar.length_ms(), calendar.length_ms()) - 0.5 * calendar.length_ms();
        } else {
            since_ms = asked_ms - static_cast<double>(label_time(weather, row).milliseconds) -
                       weather.centre.offset_h * kHourMs;
        }
        if (since_ms >= 0.0 && since_ms < before_ms) {
            before = &row;
            before_ms = since_ms;
        }
        if (since_ms <= 0.0 && -since_ms < after_ms) {
            after = &row;
            after_ms = -since_ms;
        }
    }
    if (before && after && before_ms + after_ms > 1.5 * interval_ms) (before_ms <= after_ms ? after : before) = nullptr;
    if (before && !after && before_ms > 0.5 * interval_ms) before = nullptr;
    if (after && !before && after_ms > 0.5 * interval_ms) after = nullptr;
    if (!before && !after) return std::nullopt;
    if (!before) before = after;
    if (!after) after = before;
    const double share = before == after ? 0.0 : before_ms / (before_ms + after_ms);
    const auto between = [&](double a, double b) { return a + share * (b - a); };
    hour.dni_w_m2 = between(*before->dni, *after->dni);
    hour.dhi_w_m2 = between(*before->dhi, *after->dhi);
    if (before->dew_point_c && after->dew_point_c)
        hour.dew_point_c = between(*before->dew_point_c, *after->dew_point_c);
    return hour;
}

}  // namespace skybake
