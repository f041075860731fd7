// A year of weather, as far as light hangs on it: the rows of a weather file, when their hours really are, and what
// they say of an instant.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/finding.h"
#include "base/site.h"
#include "sky/utc_time.h"

namespace skybake {

/// One record of a weather file. What the file marks as missing is absent here.
struct WeatherRow {
    std::uint64_t line = 0;  // of the file, from 1
    int year = 0;            // of a typical year, each month may have its own
    int month = 1;
    int day = 1;
    double label_h = 0.0;  // the record's clock time in local standard time, hours since the day's midnight, −1…24
    std::optional<double> dry_bulb_c;
    std::optional<double> dew_point_c;
    std::optional<double> pressure_pa;
    std::optional<double> ghi;  // W m⁻², mean over the record's interval, as the next two
    std::optional<double> dni;
    std::optional<double> dhi;
};

/// Where the weather was, from the file's header.
struct WeatherStation {
    std::string city;
    std::string region;
    std::string country;
    std::string source;
    std::string wmo;  // number of the World Meteorological Organization
    Site site;
    double utc_offset_h = 0.0;  // of its local standard time, east positive
};

/// Where the middle of a record's interval lies.
struct HourCentre {
    double offset_h = -0.5;    // from the record's label; the format promises half an interval before it
    bool is_detected = false;  // from the radiation; else it is what the format promises
    double confidence =
        0.0;  // 0…1: 1 − residual over that of half an interval earlier and later; 0 when nothing is known
    double residual_w_m2 = 0.0;           // mean of |GHI − DHI − DNI sin h| over the day's rows at the offset
    double standard_residual_w_m2 = 0.0;  // the same where the format promises the centre
};

struct Weather {
    std::filesystem::path file;
    WeatherStation station;
    int records_per_hour = 1;
    std::vector<WeatherRow> rows;     // usable ones, in the order of the file, no moment twice
    std::uint64_t rows_left_out = 0;  // unusable ones

    // Of settle_weather:
    HourCentre centre;
    bool has_leap_day = false;  // the rows hold 29 February
    // Some hour of the calendar stands there in more than one year: an instant finds the rows of its own year only.
    // Else it finds those of its month, day and time, whatever the year.
    bool spans_years = false;

    double interval_h() const { return 1.0 / records_per_hour; }
    /// The file's name without folder, for messages.
    std::string name() const { return file.filename().string(); }
};

/// The instant of a row's label.
UtcTime label_time(const Weather& weather, const WeatherRow& row);

/// Where the rows' intervals have their middle, from the radiation itself: the offset from the label, within half a
/// day, at which GHI = DHI + DNI sin h holds best, with the sun's geometric elevation h (0 when below the horizon,
/// where there should be no GHI either). Good to a minute; offsets within three minutes of a quarter of an hour are
/// taken as that. Detected means a confidence of 0.1 or more from at least 48 rows with sunshine. Takes some 50 ms.
HourCentre find_hour_centre(const Weather& weather);

/// Makes the rows fit for light, in this order: columns that are evidently exchanged are put right (SB708), the hours'
/// middle is found (SB709, SB710), one missing value of GHI, DNI and DHI is computed from the two others (SB705). What
/// stays is told: hours without radiation (SB706), hours whose radiation does not add up (SB707), missing hours
/// (SB704), a time zone that does not fit the longitude (SB714).
void settle_weather(Weather& weather, FindingLog& findings);

/// Sums over all rows that have the value, kWh m⁻².
struct WeatherSums {
    double ghi = 0.0;
    double dni = 0.0;
    double dhi = 0.0;
};
WeatherSums sums_of(const Weather& weather);

/// The years of the rows, in ascending order.
std::vector<int> years_of(const Weather& weather);
/// How many records the file's span would have without gaps: those of a calendar year, or, if it spans years, of the
/// time from its first to its last row.
std::uint64_t expected_rows(const Weather& weather);

/// The radiation of one instant.
struct WeatherHour {
    double dni_w_m2 = 0.0;
    double dhi_w_m2 = 0.0;
    std::optional<double> dew_point_c;
    bool is_leap_day_replaced = false;  // 29 February asked of a file without: it is 28 February's
};

/// Linear between the middles of the rows before and after the instant, so that a row counts wholly at its middle and a
/// series of instants has no steps; the last row of a calendar year is followed by the first. Where one of the two is
/// missing, the other counts for its own interval. Nothing where the file has no radiation. Costs about 0.1 ms.
std::optional<WeatherHour> weather_at(const Weather& weather, UtcTime instant);

}  // namespace skybake
