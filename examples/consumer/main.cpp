// Uses skybake without its program: finds the sun over Graz, then bakes a city of one house that it writes itself.
#include <skybake/skybake.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace {

const char* const kHouse =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],"translate":[0,0,0]},
"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/31256"},
"CityObjects":{"house":{"type":"Building","geometry":[{"type":"Solid","lod":"1","boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],
[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]}]}},
"vertices":[[0,0,0],[10000,0,0],[10000,8000,0],[0,8000,0],[0,0,6000],[10000,0,6000],[10000,8000,6000],[0,8000,6000]]})";

}  // namespace

int main() {
    const skybake::api::Sun sun = skybake::api::sun_position("2006-06-21T11:00:00Z", 47.0707, 15.4395, 353.0);
    std::printf("skybake %s: the sun over Graz at azimuth %.4f, elevation %.4f\n", skybake::api::version().c_str(),
                sun.azimuth_deg, sun.elevation_deg);
    if (std::abs(sun.elevation_deg - 66.369243) > 0.0005) return 1;  // pvlib's NREL SPA

    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "skybake-consumer";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "house.city.json") << kHouse;
    skybake::api::Bake settings;
    settings.files = {(folder / "house.city.json").string()};
    settings.output = (folder / "lit").string();
    settings.sun_direction_deg = {180.0, 45.0};
    settings.ground = "plane";
    const skybake::api::BakeResult result = skybake::api::bake(settings);
    std::printf("%llu building, %llu texels, %zu findings\n", static_cast<unsigned long long>(result.buildings),
                static_cast<unsigned long long>(result.texels), result.findings.size());
    try {
        settings.files = {(folder / "absent.json").string()};
        skybake::api::bake(settings);
        return 1;
    } catch (const skybake::api::Error& error) {
        std::printf("refused as it should be: %s\n", error.what());
    }
    std::filesystem::remove_all(folder);
    return result.buildings == 1 ? 0 : 1;
}
