// Where on Earth a city lies, and which way north is.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "base/finding.h"
#include "base/site.h"
#include "base/vec.h"
#include "city/city_model.h"

namespace skybake {

/// Grid north against true north at the city's centre: `convergence_rad` is the azimuth of grid north, clockwise from
/// true north, so that azimuth_true = azimuth_grid + convergence_rad. (The surveyor's meridian convergence has this
/// sign: positive east of the central meridian on the northern half.)
struct Georeference {
    std::optional<Site> site;  // none when the CRS is unknown: the user must give --site
    double convergence_rad = 0.0;
    std::string crs_name;  // "EPSG:31256 MGI / Austria GK East", or empty
    std::string crs_code;  // "EPSG:31256", or empty
    /// The system of the coordinates as they are now: the code, or, where they were projected to metres, the definition
    /// that PROJ reads; empty when unknown.
    std::string coordinate_crs{};
    // Where coordinates were projected to metres about the city's middle: PROJ's definition of that projection, and the
    // WKT of the geographic system under it. Empty where coordinates are still those of the CRS.
    std::string local_projection{};
    std::string local_geographic{};
};

/// Brings the city into metres that are true metres and tells where it lies. A projected CRS stays as it is. Geographic
/// and Web Mercator coordinates are projected to a transverse Mercator about the city's own centre (findings SB301,
/// SB302); a CRS that PROJ does not know, or none, leaves the coordinates and gives no site (SB303, SB304); so do
/// coordinates outside the CRS's area of use (SB305). Other projections whose scale is off by more than 0.1 %, feet
/// included, are treated like Web Mercator (SB302). Places about the Earth's centre (EPSG:4978) become degrees first.
/// Where the CRS has its north axis first and the solids are inside out, x and y are exchanged first (SB307).
/// Thread-safe.
Georeference georeference(CityModel& city, FindingLog& findings);

/// For writing: a city whose coordinates were projected to metres about its own middle comes into UTM on WGS 84, which
/// a file can name; others stay. `city.crs` becomes the URL of its system, empty where that has no EPSG code.
void to_named_system(CityModel& city, const Georeference& georeference);

/// Brings the objects from `first_object` on, whose file names the system `from`, into the system of the city (SB308).
/// Heights stay as they are. Where no way is known between the two, they stay as one (SB306); systems with the same map
/// coordinates are one.
void bring_into_system(CityModel& city, std::size_t first_object, const std::string& from, const std::string& file,
                       FindingLog& findings);

/// True when the coordinates of the system with that name are degrees.
bool is_geographic_crs(const std::string& name);

}  // namespace skybake
