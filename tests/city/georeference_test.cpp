// Places, north and true metres. Truth: PROJ's own factors, geodesic distances, and known towns.
#include "city/georeference.h"

#include <gtest/gtest.h>
#include <proj.h>

#include <cmath>
#include <thread>

#include "polygons.h"

namespace skybake {
namespace {

CityModel city_at(const std::string& crs, const Vec3d& p, double step = 10.0) {
    CityModel city;
    city.crs = crs;
    city.files = {"a.json"};
    city.objects.emplace_back();
    add_polygon(city.objects[0].geometry,
                {{p, p + Vec3d(step, 0, 0), p + Vec3d(step, step, 0), p + Vec3d(0, step, 0)}});
    return city;
}

double lat(const Georeference& g) {
    return degrees_from_radians(g.site.value().latitude_rad);
}
double lon(const Georeference& g) {
    return degrees_from_radians(g.site.value().longitude_rad);
}

TEST(Georeference, ReadsCodesUrlsUrnsAndCompounds) {
    for (const char* crs : {"EPSG:28992", "https://www.opengis.net/def/crs/EPSG/0/28992",
                            "http://www.opengis.net/def/crs/EPSG/9.9.1/28992", "urn:ogc:def:crs:EPSG::28992",
                            "urn:ogc:def:crs:EPSG:6.9:28992", "EPSG:7415", "EPSG:28992+5709",
                            "urn:ogc:def:crs,crs:EPSG::28992,crs:EPSG::5709", "28992"}) {
        CityModel city = city_at(crs, {84'500, 447'000, 0});
        FindingLog findings;
        const Georeference g = georeference(city, findings);
        ASSERT_TRUE(g.site.has_value()) << crs;
        EXPECT_NEAR(lat(g), 52.006, 0.005) << crs;  // Delft
        EXPECT_NEAR(lon(g), 4.363, 0.005) << crs;
        EXPECT_TRUE(findings.empty()) << crs;
        EXPECT_EQ(g.crs_code.rfind("EPSG:", 0), 0u);
    }
}

TEST(Georeference, ConvergenceIsThatOfProj) {
    struct Case {
        const char* crs;
        Vec3d place;
    };
    for (const Case& c : {Case{"EPSG:32633", {300'000, 5'200'000, 0}}, Case{"EPSG:32633", {700'000, 5'200'000, 0}},
                          Case{"EPSG:32734", {264'000, 6'242'000, 0}}}) {
        CityModel city = city_at(c.crs, c.place);
        FindingLog findings;
        const Georeference g = georeference(city, findings);
        ASSERT_TRUE(g.site.has_value()) << c.crs;
        PJ* crs = proj_create(nullptr, c.crs);
        PJ* geodetic = proj_crs_get_geodetic_crs(nullptr, crs);
        PJ* raw = proj_create_crs_to_crs_from_pj(nullptr, crs, geodetic, nullptr, nullptr);
        PJ* inverse = proj_normalize_for_visualization(nullptr, raw);
        const PJ_COORD degrees = proj_trans(inverse, PJ_FWD, proj_coord(c.place.x + 5, c.place.y + 5, 0, HUGE_VAL));
        const PJ_FACTORS factors =
            proj_factors(crs, proj_coord(proj_torad(degrees.xy.x), proj_torad(degrees.xy.y), 0, 0));
        // PROJ and surveyors agree on size; positive is east of the central meridian on the northern half.
        EXPECT_NEAR(std::abs(g.convergence_rad), std::abs(factors.meridian_convergence), 1e-7) << c.crs;
        for (PJ* p : {crs, geodetic, raw, inverse}) proj_destroy(p);
    }
    // Graz in EPSG:31256, whose first axis is north: tan γ = tan(λ - λ0) sin φ on the sphere, λ0 = 16° 20′.
    CityModel graz = city_at("EPSG:31256", {-68'000, 215'000, 0});
    FindingLog none;
    const Georeference g = georeference(graz, none);
    // Metres east of the meridian over the parallel's radius, to 1 %.
    const double delta = -68'000 / (6'388'000 * std::cos(radians_from_degrees(lat(g))));
    EXPECT_NEAR(g.convergence_rad, std::atan(std::tan(delta) * std::sin(radians_from_degrees(lat(g)))), 2e-4);
    CityModel west = city_at("EPSG:32633", {300'000, 5'200'000, 0});
    CityModel east = city_at("EPSG:32633", {700'000, 5'200'000, 0});
    FindingLog findings;
    EXPECT_LT(georeference(west, findings).convergence_rad, 0.0);
    EXPECT_GT(georeference(east, findings).convergence_rad, 0.0);
}

/// Length of the city's first edge and of its last against the ellipsoid's.
void expect_true_metres(const std::string& crs, const Vec3d& p, double step, double true_east, double true_north,
                        const std::string& code) {
    CityModel city = city_at(crs, p, step);
    FindingLog findings;
    const Georeference g = georeference(city, findings);
    ASSERT_TRUE(g.site.has_value()) << crs;
    EXPECT_EQ(findings.count(code), 1u) << crs;
    const auto& v = city.objects[0].geometry.vertices;
    EXPECT_NEAR(glm::distance(v[0], v[1]) / true_east, 1.0, 1e-3) << crs;
    EXPECT_NEAR(glm::distance(v[1], v[2]) / true_north, 1.0, 1e-3) << crs;
    EXPECT_GT(v[1].x, v[0].x);
    EXPECT_GT(v[2].y, v[1].y);
    EXPECT_EQ(g.convergence_rad, 0.0);
}

TEST(Georeference, WebMercatorDegreesAndFeetBecomeTrueMetres) {
    // At 47.07° N a metre of Web Mercator is cos(47.07°) = 0.6811 m (1 % more to the north is the ellipsoid's part).
    const double phi = radians_from_degrees(47.07);
    const double e2 = 0.00669437999014, a = 6378137.0;
    const double w = std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
    const double east_per_rad = a * std::cos(phi) / w, north_per_rad = a * (1 - e2) / (w * w * w);
    const double y = a * std::log(std::tan(kPi / 4 + phi / 2));
    expect_true_metres("EPSG:3857", {1'718'000, y, 400}, 100, 100 * east_per_rad / a,
                       100 * north_per_rad * std::cos(phi) / a, "SB302");
    const double degree = kPi / 180;
    expect_true_metres("EPSG:4258", {15.44, 47.07, 400}, 0.001, 0.001 * degree * east_per_rad,
                       0.001 * degree * north_per_rad, "SB301");  // 15 N 47 E is not in Europe
    expect_true_metres("EPSG:2263", {985'000, 210'000, 100}, 1000, 304.8006, 304.8006,
                       "SB302");  // New York, US survey feet
}

TEST(Georeference, LatitudeFirstIsUnderstood) {
    CityModel city = city_at("EPSG:6697", {35.679, 139.718, 30}, 0.001);  // JGD2011, Tokyo: latitude, longitude, height
    FindingLog findings;
    const Georeference g = georeference(city, findings);
    ASSERT_TRUE(g.site.has_value());
    EXPECT_NEAR(lat(g), 35.6795, 1e-3);
    EXPECT_NEAR(lon(g), 139.7185, 1e-3);
    const auto& v = city.objects[0].geometry.vertices;
    EXPECT_GT(v[1].y - v[0].y, 100.0) << "the file's first axis is north";
}

TEST(Georeference, UnknownAbsentAndUnfittingSystemsAskForTheSite) {
    const auto code_of = [](const std::string& crs, const Vec3d& p) {
        CityModel city = city_at(crs, p);
        FindingLog findings;
        EXPECT_FALSE(georeference(city, findings).site.has_value()) << crs;
        return findings.empty() ? std::string() : findings.list().front().code;
    };
    EXPECT_EQ(code_of("", {0, 0, 0}), "SB304");
    EXPECT_EQ(code_of("EPSG:999999", {0, 0, 0}), "SB303");
    EXPECT_EQ(code_of("local grid of 1890", {0, 0, 0}), "SB303");
    EXPECT_EQ(code_of("EPSG:5773", {0, 0, 30}), "SB303");  // heights alone (EGM96)
    EXPECT_EQ(code_of("EPSG:28992", {3.5, 4.5, 0}), "SB305");
}

TEST(Georeference, ThreadsDoNotMeet) {
    std::vector<std::thread> threads;
    std::vector<double> latitudes(4);
    for (std::size_t i = 0; i < latitudes.size(); ++i) {
        threads.emplace_back([&latitudes, i] {
            CityModel city = city_at("EPSG:28992", {84'500, 447'000, 0});
            FindingLog findings;
            latitudes[i] = georeference(city, findings).site.value().latitude_rad;
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const double latitude : latitudes) EXPECT_EQ(latitude, latitudes[0]);
}

}  // namespace
}  // namespace skybake
