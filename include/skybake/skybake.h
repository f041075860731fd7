// skybake as a library: daylight of whole cities. Only standard types; link skybake::skybake (find_package(skybake)).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#if defined(_WIN32)
#define SKYBAKE_API
#else
#define SKYBAKE_API __attribute__((visibility("default")))
#endif

namespace skybake::api {

/// "0.1.0"
SKYBAKE_API std::string version();

/// Unusable input: the message names file, place, fault and remedy.
class SKYBAKE_API Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The sun at one instant and place.
struct Sun {
    double azimuth_deg = 0.0;             // clockwise from true north
    double elevation_deg = 0.0;           // geometric, topocentric
    double apparent_elevation_deg = 0.0;  // with refraction at 1010 hPa and 10 °C
    double distance_au = 1.0;
};

/// Position of the sun by NREL SPA (Reda & Andreas 2004; within 0.0005°). `time` is ISO 8601 with offset or Z;
/// `latitude_deg` and `longitude_deg` are geodetic WGS 84, north and east positive. Throws Error for anything else.
/// Thread-safe.
SKYBAKE_API Sun sun_position(const std::string& time, double latitude_deg, double longitude_deg,
                             double elevation_m = 0.0);

/// A finding about a part of the input: what it is, and what was done about it (docs/findings.md).
struct Note {
    std::string code;
    std::string severity;  // "info", "warning" or "error"
    std::string where, what, remedy;
    std::uint64_t count = 1;
};

/// What to bake; the names, values and defaults of the command line (`skybake bake --help`).
struct Bake {
    std::vector<std::string> files;
    std::string output;
    std::vector<std::string> at;                             // instants, ISO 8601; or
    std::optional<std::array<double, 2>> sun_direction_deg;  // azimuth from true north, elevation
    std::optional<std::array<double, 2>> site_deg;           // latitude, longitude; default: from the city's CRS
    std::string sky = "preetham:turbidity=3,level=clearsky";
    std::string sun = "point";
    std::string ground = "none";  // "plane" or "draped" for a city without one
    std::string lod;              // empty: the highest of each object
    double texel_m = 0.5;
    int sky_samples = 1024;
    std::string sampling = "projected";  // or "hierarchical" or "full", as --sampling
    double tolerance = 0.01;             // of the hierarchies, relative
    std::string indirect = "none";       // reflected light: "photons" or "reference" (unbiased paths, slow)
    int bounces = 8;                     // reflections at most
    std::optional<std::uint64_t>
        photons;       // for each instant; default: 40 a square metre of surface, at least 1 million
    int paths = 1024;  // per texel, of the reference
    std::uint64_t seed = 0;
    /// Called now and then with the stage's name and the share done, 0…1, from any thread; return false to stop.
    std::function<bool(const std::string& stage, double share)> progress;
};

struct BakeResult {
    std::uint64_t buildings = 0, triangles = 0, charts = 0, pages = 0, texels = 0, sky_rays = 0;
    double seconds = 0.0;
    double evaluated_fraction = 1.0;
    double indirect_mean_lx = 0.0;   // reflected light over all texels; 0 without
    double indirect_error_lx = 0.0;  // root mean square of its standard error; 0 without the reference
    std::vector<Note> findings;
};

/// Reads the city, computes sun, sky and what is reflected, and writes the folder of the bake (docs/formats.md; the
/// walkthrough's own files are added by the program `skybake`). Throws Error for unusable input, and when `progress`
/// returned false. Two bakes in one process do not meet.
SKYBAKE_API BakeResult bake(const Bake& settings);

}  // namespace skybake::api
