#include "sky/utc_time.h"

#include <date/date.h>
#include <date/tz.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/nearest_word.h"

namespace skybake {

namespace {

using std::chrono::milliseconds;
using LocalMilliseconds = date::local_time<milliseconds>;

constexpr int kLastYear = 6000;  // of NREL SPA

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
    throw InputError(
        fmt::format("--at '{}': {}. Write for example 2026-06-21T12:00+02:00, 2026-06-21T10:00Z, or with --timezone "
                    "Europe/Vienna 2026-06-21T12:00.",
                    text, why));
}

/// Walks over the text of one instant.
class Reader {
  public:
    explicit Reader(std::string_view text) : text_(text), rest_(text) {}

    bool is_done() const { return rest_.empty(); }
    char peek() const { return rest_.empty() ? '\0' : rest_.front(); }
    bool skip(char c) {
        if (peek() != c) return false;
        rest_.remove_prefix(1);
        return true;
    }
    void expect(char c, const char* after) {
        if (!skip(c)) refuse(text_, fmt::format("there is no '{}' after the {}", c, after));
    }
    /// Exactly `digits` decimal digits.
    int number(std::size_t digits, const char* what, int low, int high) {
        int value = 0;
        for (std::size_t i = 0; i < digits; ++i) {
            if (peek() < '0' || peek() > '9') refuse(text_, fmt::format("the {} is not {} digits", what, digits));
            value = value * 10 + (peek() - '0');
            rest_.remove_prefix(1);
        }
        if (value < low || value > high)
            refuse(text_, fmt::format("the {} {} is not in {}…{}", what, value, low, high));
        return value;
    }
    /// The decimals of a second, as milliseconds; digits beyond the third are cut.
    int fraction_ms() {
        int value = 0;
        int digits = 0;
        for (; peek() >= '0' && peek() <= '9'; rest_.remove_prefix(1), ++digits) {
            if (digits < 3) value = value * 10 + (peek() - '0');
        }
        if (digits == 0) refuse(text_, "there are no digits after the second's decimal point");
        for (; digits < 3; ++digits) value *= 10;
        return value;
    }

  private:
    std::string_view text_;
    std::string_view rest_;
};

/// Clock time as written, and the offset if there was one.
struct ClockTime {
    LocalMilliseconds local;
    std::optional<int> utc_offset_min;
};

date::sys_days day_of(int year, int month, int day, std::string_view text) {
    const date::year_month_day ymd{date::year{year}, date::month{static_cast<unsigned>(month)},
                                   date::day{static_cast<unsigned>(day)}};
    if (!ymd.ok()) refuse(text, fmt::format("there is no day {:04}-{:02}-{:02}", year, month, day));
    return date::sys_days{ymd};
}

ClockTime parse_clock_time(std::string_view text) {
    Reader reader(text);
    const int year = reader.number(4, "year", 1, kLastYear);
    reader.expect('-', "year");
    const int month = reader.number(2, "month", 1, 12);
    reader.expect('-', "month");
    const int day = reader.number(2, "day", 1, 31);
    if (!reader.skip('T') && !reader.skip('t')) reader.expect(' ', "day, nor a 'T'");
    const int hour = reader.number(2, "hour", 0, 24);
    reader.expect(':', "hour");
    const int minute = reader.number(2, "minute", 0, 59);
    int second = 0;
    int millisecond = 0;
    if (reader.skip(':')) {
        second = reader.number(2, "second", 0, 59);
        if (reader.skip('.')) millisecond = reader.fraction_ms();
    }
    if (hour == 24 && (minute > 0 || second > 0 || millisecond > 0)) refuse(text, "the hour 24 exists only as 24:00");

    ClockTime clock;
    const date::local_days local_day{day_of(year, month, day, text).time_since_epoch()};
    clock.local = local_day + std::chrono::hours(hour) + std::chrono::minutes(minute) + std::chrono::seconds(second) +
                  milliseconds(millisecond);
    if (reader.is_done()) return clock;
    if (reader.skip('Z') || reader.skip('z')) {
        clock.utc_offset_min = 0;
    } else {
        const bool is_west = reader.peek() == '-';
        if (!reader.skip('+') && !reader.skip('-'))
            refuse(text, "after the time stands neither Z nor an offset such as +02:00");
        const int offset_hours = reader.number(2, "offset's hour", 0, 18);
        int offset_minutes = 0;
        if (!reader.is_done()) {
            reader.skip(':');
            offset_minutes = reader.number(2, "offset's minute", 0, 59);
        }
        clock.utc_offset_min = (is_west ? -1 : 1) * (60 * offset_hours + offset_minutes);
    }
    if (!reader.is_done()) refuse(text, "something follows after the offset");
    return clock;
}

const date::time_zone& zone_of(const std::string& name) {
    const date::tzdb* database = nullptr;
    try {
        database = &date::get_tzdb();
    } catch (const std::runtime_error& error) {
        throw InputError(fmt::format(
            "--timezone '{}': the system's time zones cannot be read ({}). Install tzdata, or write times with "
            "an offset.",
            name, error.what()));
    }
    try {
        return *date::locate_zone(name);
    } catch (const std::runtime_error&) {
        std::vector<std::string> known;
        for (const date::time_zone& zone : database->zones) known.push_back(zone.name());
        throw InputError(fmt::format("--timezone '{}' is not an IANA time zone; did you mean '{}'?", name,
                                     nearest_word(name, known)));
    }
}

std::string clock_text(LocalMilliseconds local) {
    return date::format("%FT%R", date::floor<std::chrono::minutes>(local));
}

Instant instant_of(LocalMilliseconds local, const date::time_zone& zone, std::string_view text) {
    const date::local_info info = zone.get_info(local);
    const auto offset_of = [](const date::sys_info& period) {
        return static_cast<int>(std::chrono::duration_cast<std::chrono::minutes>(period.offset).count());
    };
    const auto offset_text = [&](const date::sys_info& period) {
        const int minutes = offset_of(period);
        return fmt::format("{}{:02}:{:02}", minutes < 0 ? '-' : '+', std::abs(minutes) / 60, std::abs(minutes) % 60);
    };
    if (info.result == date::local_info::nonexistent) {
        throw InputError(fmt::format(
            "--at '{}': {} does not exist in {}: the clocks go from {} to {} then. Write the time with its offset.",
            text, clock_text(local), zone.name(), offset_text(info.first), offset_text(info.second)));
    }
    if (info.result == date::local_info::ambiguous) {
        throw InputError(
            fmt::format("--at '{0}': {1} occurs twice in {2}, as the clocks go back then. Write {1}{3} or {1}{4}.",
                        text, clock_text(local), zone.name(), offset_text(info.first), offset_text(info.second)));
    }
    // Old local mean times have offsets with seconds, which ISO 8601 cannot write: the instant stays exact, its label
    // is rounded.
    const milliseconds utc = local.time_since_epoch() - milliseconds(info.first.offset);
    return {UtcTime{utc.count()}, offset_of(info.first)};
}

Instant instant_of(const ClockTime& clock, const std::optional<std::string>& timezone, std::string_view text) {
    if (clock.utc_offset_min) {
        const milliseconds utc = clock.local.time_since_epoch() - std::chrono::minutes(*clock.utc_offset_min);
        return {UtcTime{utc.count()}, *clock.utc_offset_min};
    }
    if (!timezone) refuse(text, "it has neither an offset nor Z, and there is no --timezone");
    return instant_of(clock.local, zone_of(*timezone), text);
}

struct Step {
    std::int64_t milliseconds = 0;
    bool is_whole_days = false;
};

Step parse_step(std::string_view step, std::string_view text) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), number);
    const std::string_view unit(end, static_cast<std::size_t>(step.data() + step.size() - end));
    double unit_ms = 0.0;
    if (unit == "s") unit_ms = 1e3;
    if (unit == "min") unit_ms = 60e3;
    if (unit == "h") unit_ms = 3600e3;
    if (unit == "d") unit_ms = 86400e3;
    const double total = std::round(number * unit_ms);
    // A million days: far beyond the calendar, and safe as an integer.
    if (error != std::errc{} || unit_ms == 0.0 || !(total >= 1.0) || total > 86400e9) {
        throw InputError(fmt::format(
            "--at '{}': the step '{}' is not a positive number with a unit of s, min, h or d. Write for example "
            "2026-06-21T04:00Z/2026-06-21T20:00Z/30min.",
            text, step));
    }
    const auto ms = static_cast<std::int64_t>(total);
    return {ms, unit == "d" && ms % 86'400'000 == 0};
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + 1);
    }
}

[[noreturn]] void refuse_number(std::string_view text) {
    throw InputError(
        fmt::format("--at '{}': more than {} instants. Take a longer step or a shorter span.", text, kMaxInstants));
}

void append_range(std::vector<Instant>& instants, const std::vector<std::string_view>& parts,
                  const std::optional<std::string>& timezone) {
    const std::string_view text(parts[0].data(),
                                static_cast<std::size_t>(parts[2].data() + parts[2].size() - parts[0].data()));
    const ClockTime start_clock = parse_clock_time(parts[0]);
    const ClockTime end_clock = parse_clock_time(parts[1]);
    const Instant start = instant_of(start_clock, timezone, parts[0]);
    const Instant end = instant_of(end_clock, timezone, parts[1]);
    const Step step = parse_step(parts[2], text);
    if (end.utc < start.utc) throw InputError(fmt::format("--at '{}': the end is before the start.", text));

    if (step.is_whole_days && !start_clock.utc_offset_min && !end_clock.utc_offset_min) {
        const date::time_zone& zone = zone_of(*timezone);
        for (LocalMilliseconds t = start_clock.local; t <= end_clock.local; t += milliseconds(step.milliseconds)) {
            if (instants.size() >= kMaxInstants) refuse_number(text);
            instants.push_back(instant_of(t, zone, text));
        }
        return;
    }
    const date::time_zone* zone = start_clock.utc_offset_min ? nullptr : &zone_of(*timezone);
    for (std::int64_t t = start.utc.milliseconds; t <= end.utc.milliseconds; t += step.milliseconds) {
        if (instants.size() >= kMaxInstants) refuse_number(text);
        int offset = start.utc_offset_min;
        if (zone) {
            const date::sys_info period = zone->get_info(date::sys_time<milliseconds>(milliseconds(t)));
            offset = static_cast<int>(std::chrono::duration_cast<std::chrono::minutes>(period.offset).count());
        }
        instants.push_back({UtcTime{t}, offset});
    }
}

}  // namespace

UtcTime utc_midnight(int year, int month, int day) {
    const std::string text = fmt::format("{:04}-{:02}-{:02}", year, month, day);
    if (year < 1 || year > kLastYear || month < 1 || month > 12 || day < 1) refuse(text, "there is no such day");
    return UtcTime{milliseconds(day_of(year, month, day, text).time_since_epoch()).count()};
}

Instant parse_instant(std::string_view text, const std::optional<std::string>& timezone) {
    return instant_of(parse_clock_time(text), timezone, text);
}

std::vector<Instant> parse_instants(std::string_view text, const std::optional<std::string>& timezone) {
    std::vector<Instant> instants;
    for (const std::string_view entry : split(text, ',')) {
        const std::vector<std::string_view> parts = split(entry, '/');
        if (parts.size() == 3) {
            append_range(instants, parts, timezone);
        } else if (parts.size() == 1) {
            if (instants.size() >= kMaxInstants) refuse_number(text);
            instants.push_back(parse_instant(entry, timezone));
        } else {
            throw InputError(fmt::format(
                "--at '{}': a range is START/END/STEP, for example 2026-06-21T04:00Z/2026-06-21T20:00Z/1h.", entry));
        }
    }
    std::vector<Instant> sorted = instants;
    std::sort(sorted.begin(), sorted.end(), [](const Instant& a, const Instant& b) { return a.utc < b.utc; });
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end(),
                                          [](const Instant& a, const Instant& b) { return a.utc == b.utc; });
    if (twice != sorted.end())
        throw InputError(fmt::format("--at names {} twice; leave one of them out.", to_iso8601(*twice)));
    return instants;
}

int standard_utc_offset_min(int year, const std::string& timezone) {
    const date::time_zone& zone = zone_of(timezone);
    auto least = std::chrono::seconds::max();
    // Clocks keep a time for weeks at least.
    const date::sys_days new_year{date::year{year} / date::January / 1};
    for (int day = 0; day < 366; day += 7) least = std::min(least, zone.get_info(new_year + date::days(day)).offset);
    return static_cast<int>(std::chrono::duration_cast<std::chrono::minutes>(least).count());
}

int utc_offset_min(UtcTime time, const std::string& timezone) {
    const date::sys_info period =
        zone_of(timezone).get_info(date::sys_time<milliseconds>(milliseconds(time.milliseconds)));
    return static_cast<int>(std::chrono::duration_cast<std::chrono::minutes>(period.offset).count());
}

int year_of(const Instant& instant) {
    const date::sys_time<milliseconds> local(
        milliseconds(instant.utc.milliseconds + std::int64_t{60'000} * instant.utc_offset_min));
    return static_cast<int>(date::year_month_day(date::floor<date::days>(local)).year());
}

std::string to_iso8601(const Instant& instant) {
    const date::sys_time<milliseconds> local(
        milliseconds(instant.utc.milliseconds + std::int64_t{60'000} * instant.utc_offset_min));
    const auto whole = date::floor<std::chrono::seconds>(local);
    const auto rest = (local - whole).count();
    std::string text = date::format("%FT%T", whole);
    if (rest != 0) text += fmt::format(".{:03}", rest);
    if (instant.utc_offset_min == 0) return text + "Z";
    const int offset = std::abs(instant.utc_offset_min);
    return text + fmt::format("{}{:02}:{:02}", instant.utc_offset_min < 0 ? '-' : '+', offset / 60, offset % 60);
}

double decimal_year(UtcTime time) {
    const auto day = date::floor<date::days>(date::sys_time<milliseconds>(milliseconds(time.milliseconds)));
    const date::year year = date::year_month_day(day).year();
    const auto begin = date::sys_days(year / date::January / 1);
    const auto length = date::sys_days((year + date::years(1)) / date::January / 1) - begin;
    const double elapsed_days =
        static_cast<double>(time.milliseconds) / 86400e3 - static_cast<double>(begin.time_since_epoch().count());
    return static_cast<double>(static_cast<int>(year)) + elapsed_days / static_cast<double>(length.count());
}

}  // namespace skybake
