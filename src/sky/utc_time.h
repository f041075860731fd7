// Instants: UTC inside, ISO 8601 at the surface.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace skybake {

/// Milliseconds of UTC since 1970-01-01T00:00Z, leap seconds not counted (POSIX).
struct UtcTime {
    std::int64_t milliseconds = 0;
    friend constexpr auto operator<=>(UtcTime, UtcTime) = default;
};

constexpr double seconds_since_1970(UtcTime t) {
    return static_cast<double>(t.milliseconds) / 1000.0;
}

/// An instant together with the offset under which it is shown to the user.
struct Instant {
    UtcTime utc;
    int utc_offset_min = 0;  // minutes east of Greenwich
    friend constexpr bool operator==(Instant, Instant) = default;
};

/// More instants than this in one list are refused: a bake of them would fill any disk.
inline constexpr std::size_t kMaxInstants = 10'000;

/// Midnight UTC of a day of the proleptic Gregorian calendar, for `year` 1…6000. Throws InputError for a day that does
/// not exist.
UtcTime utc_midnight(int year, int month, int day);

/// "2026-06-21T12:00+02:00", "…T10:00Z", seconds and their decimals optional, a blank for the T; years 0001…6000.
/// Without offset the time is read as local to `timezone`, an IANA name ("Europe/Vienna"). Throws InputError, saying
/// what to write instead: without offset and time zone, for times that a switch to summer time skips or repeats, for
/// days that do not exist and zones that nobody knows.
Instant parse_instant(std::string_view text, const std::optional<std::string>& timezone);

/// The value of --at: one instant, a comma list, START/END/STEP (STEP = a number and s, min, h or d; END included when
/// a step meets it), or a list of both. In local time with a time zone, steps of whole days keep the local clock time
/// when summer time comes or goes. Throws InputError as parse_instant does, and for more than kMaxInstants, an END
/// before its START and an instant that occurs twice.
std::vector<Instant> parse_instants(std::string_view text, const std::optional<std::string>& timezone);

/// The least offset from UTC, minutes, that the clocks of an IANA zone have in a year: that of its standard time.
/// Throws InputError for a zone that nobody knows.
int standard_utc_offset_min(int year, const std::string& timezone);

/// The offset from UTC, minutes, of the clocks of an IANA zone at an instant. Throws InputError as above.
int utc_offset_min(UtcTime time, const std::string& timezone);

/// The calendar year of an instant by its own offset.
int year_of(const Instant& instant);

/// ISO 8601 with the instant's own offset: "2026-06-21T12:00:00+02:00", "…Z" for offset 0; milliseconds only where
/// there are any.
std::string to_iso8601(const Instant& instant);

/// The calendar year with its fraction, e.g. 2026.47 for June 2026.
double decimal_year(UtcTime time);

}  // namespace skybake
