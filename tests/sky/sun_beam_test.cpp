#include "sky/sun_beam.h"

#include <gtest/gtest.h>

#include "sky/reference_table.h"
#include "sky/spectral_tables.h"
#include "test_data.h"

namespace skybake {
namespace {

// Truth: the authors' own program (as ported to Mitsuba): each transmittance 1e-6 (its radiances carry one digit less:
// 7e-4).
TEST(SunBeam, TransmittancesAreThoseOfTheAuthorsProgram) {
    const auto path = test_data("reference/preetham_sun_spectrum.csv");
    SKYBAKE_NEEDS_DATA(path);
    const auto rows = read_reference(path);
    ASSERT_GT(rows.size(), 100u);
    for (const ReferenceRow& row : rows) {
        SCOPED_TRACE(row.text("id") + " " + row.text("lambda_nm"));
        const double lambda = row.number("lambda_nm");
        const double m = air_mass(radians_from_degrees(row.number("sun_zenith_deg")));
        EXPECT_NEAR(m, row.number("air_mass"), 1e-6 * m);
        const BeamTransmittance tau = beam_transmittance(lambda, m, row.number("turbidity"));
        EXPECT_NEAR(tau.rayleigh, row.number("tau_rayleigh"), 1e-6);
        EXPECT_NEAR(tau.aerosol, row.number("tau_aerosol"), 1e-6);
        EXPECT_NEAR(tau.ozone, row.number("tau_ozone"), 1e-6);
        EXPECT_NEAR(tau.mixed_gases, row.number("tau_gas"), 1e-6);
        EXPECT_NEAR(tau.water_vapour, row.number("tau_water"), 1e-6);
        const double radiance = row.number("L_sun_W_m2_sr_nm_utah");
        EXPECT_NEAR(tau.total() * extraterrestrial_sun_radiance(lambda), radiance, 7e-4 * radiance);
    }
}

// Truth: the sum of the authors' radiances over the CIE 1931 observer, 5 nm, 6.7443e-5 sr.
TEST(SunBeam, IlluminanceAndColourAgreeWithTheReference) {
    const auto path = test_data("reference/preetham_sun_direct.csv");
    SKYBAKE_NEEDS_DATA(path);
    const auto rows = read_reference(path);
    ASSERT_GT(rows.size(), 20u);
    for (const ReferenceRow& row : rows) {
        SCOPED_TRACE(row.text("id"));
        const double zenith = radians_from_degrees(row.number("sun_zenith_deg"));
        if (row.number("sun_zenith_deg") >= 90.0) continue;
        const Xyz xyz = sun_normal_illuminance(row.number("turbidity"), zenith, 1.0);
        EXPECT_NEAR(xyz.y, row.number("En_lux"), 0.005 * row.number("En_lux"));
        if (row.number("En_lux") <= 0.0) continue;
        const double sum = xyz.x + xyz.y + xyz.z;
        EXPECT_NEAR(xyz.x / sum, row.number("x"), 0.002);
        EXPECT_NEAR(xyz.y / sum, row.number("y"), 0.002);
        // What the renderer gets has the same illuminance, whatever the cut to Rec. 709 did to the colour.
        EXPECT_NEAR(luminance(rgb_from_xyz(xyz)), xyz.y, 1e-5 * xyz.y);
    }
}

// Truth: no beam from below the horizon; the inverse square of the distance.
TEST(SunBeam, EndsAtTheHorizonAndFallsWithTheDistance) {
    EXPECT_EQ(sun_normal_illuminance(3.0, kPi / 2.0, 1.0).y, 0.0);
    EXPECT_EQ(sun_normal_illuminance(3.0, kPi, 1.0).y, 0.0);
    EXPECT_NEAR(sun_normal_illuminance(3.0, 0.5, 1.0).y / sun_normal_illuminance(3.0, 0.5, 1.0167).y, 1.0167 * 1.0167,
                1e-9);
}

}  // namespace
}  // namespace skybake
