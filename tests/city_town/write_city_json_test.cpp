// What the writer writes: the rules of CityJSON 2.0 (https://www.cityjson.org/specs/2.0.1/) held by hand, and the
// reader brings the city back.
#include "io/cityjson/write_city_json.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "city/town/town.h"
#include "io/cityjson/read_cityjson.h"

namespace skybake::io {
namespace {

using nlohmann::json;

struct TemporaryFolder {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("skybake_write_" + std::to_string(getpid()));
    TemporaryFolder() { std::filesystem::create_directories(path); }
    ~TemporaryFolder() { std::filesystem::remove_all(path); }
};

const CityModel& town() {
    static const CityModel city = build_town({.buildings = 60, .seed = 2, .variant = TownVariant::as_built}).city;
    return city;
}

/// Surfaces of a geometry, whatever its nesting.
std::vector<json> surfaces_of(const std::string& type, const json& nested) {
    const int depth = type == "MultiSolid" ? 2 : type == "Solid" ? 1 : 0;
    std::vector<json> level(nested.begin(), nested.end());
    for (int d = 0; d < depth; ++d) {
        std::vector<json> below;
        for (const json& item : level) below.insert(below.end(), item.begin(), item.end());
        level = std::move(below);
    }
    return level;
}

void check_objects(const json& objects, const json& appearance, std::size_t vertices) {
    const std::set<std::string> building_surfaces = {"GroundSurface", "WallSurface", "RoofSurface",
                                                     "OuterCeilingSurface"};
    for (const auto& [id, object] : objects.items()) {
        for (const json& parent : object.value("parents", json::array())) {
            const json& children = objects.at(parent.get<std::string>()).at("children");
            EXPECT_NE(std::find(children.begin(), children.end(), id), children.end()) << id;
        }
        if (object.at("type") == "BuildingPart") {
            EXPECT_TRUE(object.contains("parents")) << id;
        }
        for (const json& geometry : object.value("geometry", json::array())) {
            const std::string type = geometry.at("type");
            EXPECT_TRUE(geometry.at("lod").is_string());
            if (object.at("type") == "TINRelief") {
                EXPECT_EQ(type, "CompositeSurface");
            }
            const std::vector<json> surfaces = surfaces_of(type, geometry.at("boundaries"));
            const std::vector<json> textures = surfaces_of(type, geometry.at("texture").begin().value().at("values"));
            ASSERT_EQ(surfaces.size(), textures.size()) << id;
            for (std::size_t s = 0; s < surfaces.size(); ++s) {
                ASSERT_EQ(surfaces[s].size(), textures[s].size()) << id;
                for (std::size_t r = 0; r < surfaces[s].size(); ++r) {
                    EXPECT_GE(surfaces[s][r].size(), 3u);
                    for (const json& v : surfaces[s][r]) EXPECT_LT(v.get<std::size_t>(), vertices);
                    ASSERT_EQ(textures[s][r].size(), surfaces[s][r].size() + 1)
                        << id;  // the texture's number, then one a corner
                    EXPECT_LT(textures[s][r][0].get<std::size_t>(), appearance.at("textures").size());
                    for (std::size_t c = 1; c < textures[s][r].size(); ++c) {
                        EXPECT_LT(textures[s][r][c].get<std::size_t>(), appearance.at("vertices-texture").size());
                    }
                }
            }
            if (!geometry.contains("semantics")) continue;
            const json& semantics = geometry["semantics"];
            std::vector<json> values(semantics["values"].begin(), semantics["values"].end());
            if (type == "Solid" || type == "MultiSolid") {
                std::size_t count = 0;
                const std::function<void(const json&)> add = [&](const json& v) {
                    if (v.is_array()) {
                        for (const json& item : v) add(item);
                    } else {
                        ++count;
                        if (!v.is_null()) {
                            EXPECT_LT(v.get<std::size_t>(), semantics["surfaces"].size());
                        }
                    }
                };
                add(semantics["values"]);
                EXPECT_EQ(count, surfaces.size()) << id;
            } else {
                EXPECT_EQ(values.size(), surfaces.size()) << id;
            }
            if (object.at("type") == "Building") {
                for (const json& s : semantics["surfaces"]) EXPECT_EQ(building_surfaces.count(s["type"]), 1u) << s;
            }
        }
    }
}

TEST(WriteCityJson, FollowsTheRulesOfVersionTwo) {
    const TemporaryFolder folder;
    write_city_json(town(), folder.path / "town.city.json");
    const json file = json::parse(std::ifstream(folder.path / "town.city.json"));
    EXPECT_EQ(file.at("type"), "CityJSON");
    EXPECT_EQ(file.at("version"), "2.0");
    EXPECT_EQ(file.at("transform").at("scale"), json({0.001, 0.001, 0.001}));
    EXPECT_EQ(file.at("metadata").at("referenceSystem"), "https://www.opengis.net/def/crs/EPSG/0/31256");
    EXPECT_EQ(file.at("CityObjects").size(), town().objects.size());
    std::set<std::array<long long, 3>> distinct;
    std::array<long long, 3> lo{1ll << 60, 1ll << 60, 1ll << 60};
    for (const json& v : file.at("vertices")) {
        ASSERT_EQ(v.size(), 3u);
        std::array<long long, 3> p{};
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_TRUE(v[k].is_number_integer());
            p[k] = v[k];
            lo[k] = std::min(lo[k], p[k]);
        }
        EXPECT_TRUE(distinct.insert(p).second) << "vertex written twice";
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const double stated = file["metadata"]["geographicalExtent"][k];
        EXPECT_NEAR(stated, static_cast<double>(lo[k]) * 1e-3 + file["transform"]["translate"][k].get<double>(), 1e-6);
    }
    check_objects(file.at("CityObjects"), file.at("appearance"), file.at("vertices").size());
}

TEST(WriteCityJson, ASequenceHasOneWholeFeatureALine) {
    const TemporaryFolder folder;
    write_city_json(town(), folder.path / "town.city.jsonl");
    std::ifstream lines(folder.path / "town.city.jsonl");
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    const json head = json::parse(line);
    EXPECT_EQ(head.at("type"), "CityJSON");
    EXPECT_TRUE(head.at("CityObjects").empty());
    EXPECT_TRUE(head.at("vertices").empty());
    std::size_t objects = 0;
    while (std::getline(lines, line)) {
        const json feature = json::parse(line);
        EXPECT_EQ(feature.at("type"), "CityJSONFeature");
        EXPECT_EQ(feature.at("CityObjects").count(feature.at("id").get<std::string>()), 1u);
        objects += feature.at("CityObjects").size();
        check_objects(feature.at("CityObjects"), feature.value("appearance", json::object()),
                      feature.at("vertices").size());
    }
    EXPECT_EQ(objects, town().objects.size());
}

class RoundTrip : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip, testing::Values("town.city.json", "town.city.jsonl"));

TEST_P(RoundTrip, TheReaderBringsTheCityBack) {
    const TemporaryFolder folder;
    write_city_json(town(), folder.path / GetParam());
    CityModel read;
    FindingLog findings;
    SilentProgress progress;
    read_cityjson(folder.path / GetParam(), {}, read, findings, progress);
    EXPECT_EQ(findings.count(Severity::error), 0u);
    EXPECT_EQ(read.crs, town().crs);
    std::map<std::string, const CityObject*> found;
    for (const CityObject& object : read.objects) found[object.id] = &object;
    ASSERT_EQ(found.size(), town().objects.size());
    for (const CityObject& ours : town().objects) {
        ASSERT_EQ(found.count(ours.id), 1u) << ours.id;
        const CityObject& theirs = *found[ours.id];
        EXPECT_EQ(theirs.type, ours.type) << ours.id;
        EXPECT_EQ(theirs.parent_id, ours.parent_id);
        EXPECT_EQ(json::parse(theirs.attributes_json), json::parse(ours.attributes_json));
        const Geometry& a = ours.geometry;
        const Geometry& b = theirs.geometry;
        ASSERT_EQ(a.surfaces.size(), b.surfaces.size()) << ours.id;
        ASSERT_EQ(a.shells.size(), b.shells.size()) << ours.id;
        ASSERT_EQ(a.corners.size(), b.corners.size()) << ours.id;
        ASSERT_EQ(b.corner_uv.size(), a.corner_uv.size()) << ours.id;
        EXPECT_EQ(a.ring_first, b.ring_first);
        for (std::size_t c = 0; c < a.corners.size(); ++c) {
            EXPECT_LT(glm::length(a.vertices[a.corners[c]] - b.vertices[b.corners[c]]), 1e-6) << ours.id;
            EXPECT_LT(glm::length(a.corner_uv[c] - b.corner_uv[c]),
                      1.5e-4f * std::max(1.0f, glm::length(a.corner_uv[c])))
                << ours.id;
        }
        for (std::size_t s = 0; s < a.surfaces.size(); ++s) {
            ASSERT_TRUE(b.surfaces[s].texture.has_value()) << ours.id;
            EXPECT_EQ(read.textures[b.surfaces[s].texture->index()].uri,
                      town().textures[a.surfaces[s].texture->index()].uri);
            if (is_building(ours.type)) {
                EXPECT_EQ(b.surfaces[s].type, a.surfaces[s].type) << ours.id;
            }
        }
        for (std::size_t s = 0; s < a.shells.size(); ++s) EXPECT_EQ(a.shells[s].kind, b.shells[s].kind) << ours.id;
    }
}

TEST(WriteCityJson, InnerShellsHolesMaterialsAndOddTextSurvive) {
    // A cube of 3 m with a hollow of 1 m, and a loose face with a hole: what the town does not have.
    CityModel city;
    city.materials.push_back({"brick \"old\"", {0.3f, 0.2f, 0.1f}, 0.0f});
    city.crs = "EPSG:7415";
    CityObject object;
    object.id = "häuser/1\n\"a\"";
    object.type = ObjectType::building;
    object.type_name = "Building";
    object.lod = "2";
    Geometry& g = object.geometry;
    const auto cube = [&](double lo, double hi, bool is_inner) {
        const auto base = static_cast<std::uint32_t>(g.vertices.size());
        for (int i = 0; i < 8; ++i) g.vertices.emplace_back((i & 1) ? hi : lo, (i & 2) ? hi : lo, (i & 4) ? hi : lo);
        const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        const auto begin = static_cast<std::uint32_t>(g.surfaces.size());
        for (const auto& face : faces) {
            for (int k = 0; k < 4; ++k) g.corners.push_back(base + face[is_inner ? 3 - k : k]);
            Surface s;
            s.ring_begin = static_cast<std::uint32_t>(g.ring_first.size() - 1);
            g.ring_first.push_back(static_cast<std::uint32_t>(g.corners.size()));
            s.ring_end = s.ring_begin + 1;
            s.type = SurfaceType::wall;
            if (!is_inner) s.material = MaterialId(0u);
            g.surfaces.push_back(s);
        }
        g.shells.push_back(
            {begin, static_cast<std::uint32_t>(g.surfaces.size()), is_inner ? Shell::Kind::inner : Shell::Kind::outer});
    };
    cube(0, 3, false);
    cube(1, 2, true);
    city.objects.push_back(object);

    const TemporaryFolder folder;
    write_city_json(city, folder.path / "odd.json");
    CityModel read;
    FindingLog findings;
    SilentProgress progress;
    read_cityjson(folder.path / "odd.json", {}, read, findings, progress);
    ASSERT_EQ(read.objects.size(), 1u);
    EXPECT_EQ(read.objects[0].id, object.id);
    ASSERT_EQ(read.objects[0].geometry.shells.size(), 2u);
    EXPECT_EQ(read.objects[0].geometry.shells[1].kind, Shell::Kind::inner);
    ASSERT_EQ(read.materials.size(), 1u);
    EXPECT_EQ(read.materials[0].name, city.materials[0].name);
    EXPECT_NEAR(read.materials[0].albedo.x, 0.3f, 1e-3f);
    EXPECT_TRUE(read.objects[0].geometry.surfaces[0].material.has_value());
    EXPECT_FALSE(read.objects[0].geometry.surfaces[6].material.has_value());
}

TEST(WriteCityJson, APlaceThatCannotBeWrittenIsAnInputError) {
    EXPECT_THROW(write_city_json(town(), "/dev/null/town.city.json"), InputError);
}

TEST(WriteCityJson, BrokenAttributesLeaveNoFile) {
    const TemporaryFolder folder;
    CityModel city;
    CityObject object;
    object.id = "a";
    object.type = ObjectType::building;
    object.attributes_json = "{broken";
    city.objects.push_back(object);
    EXPECT_THROW(write_city_json(city, folder.path / "a.json"), InputError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

}  // namespace
}  // namespace skybake::io
