// What the reader makes of files of a few lines. Truth: the CityGML and GML specifications, and cubes whose figures are
// plain.
#include "io/citygml/read_citygml.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "gml_text.h"

namespace skybake {
namespace {

using testing::HasSubstr;

TEST(ReadCityGml, ACubeIsAClosedSolidWithAttributes) {
    const LoadedCity city = load_gml(
        gml_document(gml_building("<gml:name>Haus</gml:name><gen:stringAttribute "
                                  "name=\"Straße\"><gen:value>Ring</gen:value></gen:stringAttribute>"
                                  "<gen:intAttribute name=\"n\"><gen:value>7</gen:value></gen:intAttribute>"
                                  "<bldg:function>1000</bldg:function><bldg:function>2000</bldg:function>"
                                  "<bldg:measuredHeight uom=\"m\">12.5</bldg:measuredHeight><bldg:lod2MultiSurface/>"
                                  "<bldg:lod2Solid>" +
                                  gml_solid(cube_members()) + "</bldg:lod2Solid>")));
    ASSERT_EQ(city.city.objects.size(), 1u);
    const CityObject& object = city.city.objects[0];
    EXPECT_EQ(object.type, ObjectType::building);
    EXPECT_EQ(object.lod, "2");
    EXPECT_EQ(object.where, "a.gml: line 3: Building 'b'");
    EXPECT_EQ(object.attributes_json,
              R"({"Straße":"Ring","function":["1000","2000"],"measuredHeight":12.5,"n":7,"name":"Haus"})");
    ASSERT_EQ(object.geometry.surfaces.size(), 6u);
    EXPECT_EQ(object.geometry.surfaces[1].type, SurfaceType::roof);
    EXPECT_EQ(object.geometry.vertices.size(), 8u);
    EXPECT_EQ(city.summary.closed_shells, 1u);
    EXPECT_EQ(city.summary.triangles, 12u);
    EXPECT_EQ(city.findings.count("SB207") + city.findings.count("SB208") + city.findings.count("SB205"), 0u);
}

TEST(ReadCityGml, ASolidByReferenceTakesTheTypesOfItsSurfaces) {
    std::string thematic;
    std::string members;
    for (int i = 0; i < 6; ++i) {
        const std::string type = i == 0   ? "GroundSurface"
                                 : i == 1 ? "RoofSurface"
                                 : i == 3 ? "ClosureSurface"
                                          : "WallSurface";
        const std::string id = "p" + std::to_string(i);
        thematic += "<bldg:boundedBy><bldg:" + type + "><bldg:lod2MultiSurface><gml:MultiSurface>" +
                    surface_member(polygon(kFaces[i], id)) +
                    "</gml:MultiSurface></bldg:lod2MultiSurface></bldg:" + type + "></bldg:boundedBy>";
        members += refer("surfaceMember", id);
    }
    const LoadedCity city =
        load_gml(gml_document(gml_building("<bldg:lod2Solid>" + gml_solid(members) + "</bldg:lod2Solid>" + thematic)));
    ASSERT_EQ(city.summary.surfaces, 6u) << "each surface once";
    EXPECT_EQ(city.summary.closed_shells, 1u);
    EXPECT_EQ(city.findings.count("SB202"), 0u) << "a reference is no repetition";
    const Geometry& g = city.city.objects[0].geometry;
    EXPECT_EQ(g.surfaces[0].type, SurfaceType::ground);
    EXPECT_EQ(g.surfaces[1].type, SurfaceType::roof);
    EXPECT_EQ(g.surfaces[2].type, SurfaceType::wall);
    EXPECT_EQ(g.surfaces[3].type, SurfaceType::closure);

    std::string copies;
    for (const std::string& face : kFaces) copies += surface_member(polygon(face));
    const LoadedCity twice =
        load_gml(gml_document(gml_building("<bldg:lod2Solid>" + gml_solid(copies) + "</bldg:lod2Solid>" + thematic)));
    EXPECT_EQ(twice.summary.surfaces, 6u);
    EXPECT_EQ(twice.findings.count("SB202"), 1u);
    EXPECT_EQ(twice.city.objects[0].geometry.surfaces[1].type, SurfaceType::roof);
}

TEST(ReadCityGml, PositionsComeInManyForms) {
    const std::string pos =
        "<gml:Polygon><gml:exterior><gml:LinearRing><gml:pos>0 0 0</gml:pos><gml:pos>+4 0 0</gml:pos>"
        "<gml:pos>4 4e0 0</gml:pos><gml:pos>0 0 0</gml:pos></gml:LinearRing></gml:exterior></gml:Polygon>";
    const std::string coordinates =
        "<gml:Polygon><gml:outerBoundaryIs><gml:LinearRing><gml:coordinates>10,0,0 14,0,0 14,4,0 "
        "10,0,0</gml:coordinates>"
        "</gml:LinearRing></gml:outerBoundaryIs></gml:Polygon>";
    const std::string flat =
        "<gml:Polygon srsDimension=\"2\"><gml:exterior><gml:LinearRing><gml:posList>20 0 24 0 24 4 20 0</gml:posList>"
        "</gml:LinearRing></gml:exterior></gml:Polygon>";
    const std::string curves =
        "<gml:Polygon><gml:exterior><gml:Ring><gml:curveMember><gml:LineString gml:id=\"c\"><gml:posList>30 0 0 34 0 0"
        "</gml:posList></gml:LineString></gml:curveMember><gml:curveMember><gml:OrientableCurve orientation=\"-\">"
        "<gml:baseCurve><gml:LineString><gml:posList>30 0 0 34 4 0 34 0 "
        "0</gml:posList></gml:LineString></gml:baseCurve>"
        "</gml:OrientableCurve></gml:curveMember></gml:Ring></gml:exterior></gml:Polygon>";
    const std::string oriented = "<gml:OrientableSurface orientation=\"-\"><gml:baseSurface>" +
                                 polygon("40 0 0 44 4 0 44 0 0 40 0 0") + "</gml:baseSurface></gml:OrientableSurface>";
    const LoadedCity city = load_gml(gml_document(
        member("<gen:GenericCityObject gml:id=\"g\"><gen:lod1Geometry><gml:MultiSurface>" + surface_member(pos) +
               surface_member(coordinates) + surface_member(flat) + surface_member(curves) + surface_member(oriented) +
               "</gml:MultiSurface></gen:lod1Geometry></gen:GenericCityObject>")));
    ASSERT_EQ(city.summary.surfaces, 5u) << finding_text(city, "SB101") << finding_text(city, "SB204");
    for (const Surface& surface : city.city.objects[0].geometry.surfaces) {
        const Geometry& g = city.city.objects[0].geometry;
        EXPECT_EQ(g.ring_first[surface.ring_end] - g.ring_first[surface.ring_begin], 3u) << surface.source_index;
    }
    EXPECT_EQ(extent_of(city.city).hi, Vec3d(44, 4, 0));
}

TEST(ReadCityGml, TerrainIsATinAndBreaklinesAreTold) {
    const std::string patch =
        "<gml:Triangle><gml:exterior>" + ring("0 0 0 9 0 1 9 9 2 0 0 0") + "</gml:exterior></gml:Triangle>";
    const LoadedCity city = load_gml(gml_document(
        member("<dem:ReliefFeature gml:id=\"f\"><dem:lod>2</dem:lod><dem:reliefComponent><dem:TINRelief gml:id=\"t\">"
               "<dem:lod>2</dem:lod><dem:tin><gml:TriangulatedSurface><gml:trianglePatches>" +
               patch +
               "</gml:trianglePatches></gml:TriangulatedSurface></dem:tin></dem:TINRelief></dem:reliefComponent>"
               "<dem:reliefComponent><dem:BreaklineRelief gml:id=\"l\"><dem:lod>2</dem:lod><dem:breaklines>"
               "<gml:MultiCurve/></dem:breaklines></dem:BreaklineRelief></dem:reliefComponent></dem:ReliefFeature>")));
    EXPECT_TRUE(city.has_own_ground);
    EXPECT_EQ(object_of(city, "t").type, ObjectType::terrain);
    EXPECT_EQ(object_of(city, "t").geometry.surfaces[0].type, SurfaceType::terrain);
    EXPECT_THAT(finding_text(city, "SB102"), HasSubstr("BreaklineRelief has no surface"));
}

TEST(ReadCityGml, PartsInstallationsWindowsAndRooms) {
    const LoadedCity city = load_gml(gml_document(gml_building(
        "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id=\"p\"><bldg:lod2Solid>" + gml_solid(cube_members()) +
        "</bldg:lod2Solid></bldg:BuildingPart></bldg:consistsOfBuildingPart>"
        "<bldg:outerBuildingInstallation><bldg:BuildingInstallation><bldg:lod3Geometry>" +
        polygon("5 0 0 6 0 0 6 0 1 5 0 0") +
        "</bldg:lod3Geometry></bldg:BuildingInstallation></bldg:outerBuildingInstallation>"
        "<bldg:interiorRoom><bldg:Room gml:id=\"r\"><bldg:lod4Solid>" +
        gml_solid(cube_members()) +
        "</bldg:lod4Solid></bldg:Room></bldg:interiorRoom>"
        "<bldg:boundedBy><bldg:WallSurface><bldg:lod3MultiSurface><gml:MultiSurface>" +
        surface_member(polygon("8 0 0 9 0 0 9 0 1 8 0 1 8 0 0")) +
        "</gml:MultiSurface></bldg:lod3MultiSurface><bldg:opening><bldg:Window><bldg:lod3MultiSurface>"
        "<gml:MultiSurface>" +
        surface_member(polygon("8.2 0 .2 8.4 0 .2 8.4 0 .6 8.2 0 .2")) +
        "</gml:MultiSurface></bldg:lod3MultiSurface></bldg:Window></bldg:opening></bldg:WallSurface></"
        "bldg:boundedBy>")));
    EXPECT_EQ(object_of(city, "p").parent_id, "b");
    EXPECT_EQ(object_of(city, "Building-1").type, ObjectType::building_installation) << "named after its place";
    EXPECT_TRUE(object_of(city, "r").geometry.is_empty());
    EXPECT_EQ(city.findings.count("SB110"), 1u);
    ASSERT_EQ(object_of(city, "b").geometry.surfaces.size(), 2u);
    EXPECT_EQ(object_of(city, "b").geometry.surfaces[0].type, SurfaceType::wall);
    EXPECT_EQ(object_of(city, "b").geometry.surfaces[1].type, SurfaceType::window);
    EXPECT_EQ(city.city.lods, (std::vector<std::string>{"2", "3", "4"}));
}

TEST(ReadCityGml, LodsAreChosenAsInCityJson) {
    const std::string lod1 = "<bldg:lod1Solid>" + gml_solid(cube_members()) + "</bldg:lod1Solid>";
    const std::string lod0 = "<bldg:lod0FootPrint><gml:MultiSurface>" + surface_member(polygon(kFaces[0])) +
                             "</gml:MultiSurface></bldg:lod0FootPrint>";
    const std::string lod2 = "<bldg:lod2MultiSurface><gml:MultiSurface>" + surface_member(polygon(kFaces[1])) +
                             "</gml:MultiSurface></bldg:lod2MultiSurface>";
    const std::string document = gml_document(gml_building(lod0 + lod1 + lod2));
    EXPECT_EQ(load_gml(document).city.objects[0].lod, "2");
    EXPECT_EQ(load_gml(document, {"1"}).city.objects[0].lod, "1");
    EXPECT_EQ(load_gml(document, {"3"}).findings.count("SB109"), 1u);
    EXPECT_EQ(load_gml(gml_document(gml_building(lod0))).findings.count("SB108"), 1u);
}

TEST(ReadCityGml, ImplicitGeometriesArePlaced) {
    const auto tree = [](const std::string& id, const std::string& shape, const std::string& at) {
        return member(
            "<veg:SolitaryVegetationObject gml:id=\"" + id +
            "\"><veg:lod2ImplicitRepresentation><ImplicitGeometry><transformationMatrix>2 0 0 0 0 2 0 0 0 0 2 1 "
            "0 0 0 1</transformationMatrix>" +
            shape + "<referencePoint><gml:Point><gml:pos>" + at +
            "</gml:pos></gml:Point></referencePoint></ImplicitGeometry></veg:lod2ImplicitRepresentation>"
            "</veg:SolitaryVegetationObject>");
    };
    const std::string shape = "<relativeGMLGeometry><gml:MultiSurface gml:id=\"shape\">" + cube_members() +
                              "</gml:MultiSurface></relativeGMLGeometry>";
    const LoadedCity city = load_gml(gml_document(
        tree("early", "<relativeGMLGeometry xlink:href=\"#shape\"/>", "20 0 0") + tree("holder", shape, "10 0 0") +
        tree("late", "<relativeGMLGeometry xlink:href=\"#shape\"/>", "30 0 0") +
        tree("file", "<libraryObject>tree.wrl</libraryObject>", "40 0 0")));
    for (const auto& [id, x] : {std::pair("early", 20.0), std::pair("holder", 10.0), std::pair("late", 30.0)}) {
        Box3d box;
        for (const Vec3d& p : object_of(city, id).geometry.vertices) box.extend(p);
        EXPECT_EQ(box.lo, Vec3d(x, 0, 1)) << id;
        EXPECT_EQ(box.hi, Vec3d(x + 2, 2, 3)) << id;
    }
    EXPECT_THAT(finding_text(city, "SB111"), HasSubstr("'tree.wrl' is a file of its own"));
    EXPECT_EQ(city.findings.count("SB111"), 1u);
}

TEST(ReadCityGml, RoadsOfThreeVersions) {
    const std::string lane = "<tran:TrafficArea><tran:lod2MultiSurface><gml:MultiSurface>" +
                             surface_member(polygon("0 0 0 9 0 0 9 3 0 0 0 0")) +
                             "</gml:MultiSurface></tran:lod2MultiSurface></tran:TrafficArea>";
    const LoadedCity two = load_gml(
        gml_document(member("<tran:Road gml:id=\"r\"><tran:trafficArea>" + lane + "</tran:trafficArea></tran:Road>")));
    EXPECT_EQ(object_of(two, "r").geometry.surfaces.size(), 1u);
    EXPECT_EQ(object_of(two, "r").geometry.surfaces[0].type, SurfaceType::road);
    const LoadedCity three = load_gml(gml_document(member(
        "<tran:Road gml:id=\"r\"><tran:section><tran:Section><tran:trafficSpace><tran:TrafficSpace><tran:lod2Solid>" +
        gml_solid(cube_members()) + "</tran:lod2Solid><tran:boundary>" + lane +
        "</tran:boundary></tran:TrafficSpace></tran:trafficSpace></tran:Section></tran:section></tran:Road>")));
    EXPECT_EQ(object_of(three, "r").geometry.surfaces.size(), 1u) << "the space above the lane is air";
}

TEST(ReadCityGml, ReferencesThatLeadNowhereOrInCircles) {
    const LoadedCity gone = load_gml(gml_document(gml_building(
        "<bldg:lod2Solid>" + gml_solid(cube_members() + refer("surfaceMember", "gone")) + "</bldg:lod2Solid>")));
    EXPECT_EQ(gone.summary.surfaces, 6u);
    EXPECT_THAT(finding_text(gone, "SB120"), HasSubstr("a.gml: line 3: surfaceMember: refers to 'gone'"));
    const LoadedCity round = load_gml(
        gml_document(gml_building("<bldg:lod2MultiSurface><gml:MultiSurface gml:id=\"a\">" +
                                  refer("surfaceMember", "a") + refer("surfaceMember", "a") +
                                  surface_member(polygon(kFaces[1])) + "</gml:MultiSurface></bldg:lod2MultiSurface>")));
    EXPECT_EQ(round.summary.surfaces, 1u);
}

TEST(ReadCityGml, NamesOfReferenceSystems) {
    const auto site_of = [](const std::string& name, const std::string& low) {
        const std::string envelope =
            "<gml:boundedBy><gml:Envelope srsName=\"" + name + "\" srsDimension=\"3\"/></gml:boundedBy>";
        std::string faces;
        std::istringstream in(low);
        double x = 0, y = 0;
        in >> x >> y;
        const std::string shape =
            fmt::format("{} {} 0 {} {} 0 {} {} 5 {} {} 0", x, y, x + 1e-4, y, x + 1e-4, y + 1e-4, x, y);
        return load_gml(gml_document(envelope + gml_building("<bldg:lod1MultiSurface><gml:MultiSurface>" +
                                                             surface_member(polygon(shape)) +
                                                             "</gml:MultiSurface></bldg:lod1MultiSurface>")))
            .georeference;
    };
    EXPECT_EQ(site_of("EPSG:25832", "678000 5403000").crs_code, "EPSG:25832");
    EXPECT_EQ(site_of("urn:ogc:def:crs:EPSG::25832", "678000 5403000").crs_code, "EPSG:25832");
    EXPECT_EQ(site_of("urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783", "678000 5403000").crs_code, "EPSG:25832+5783");
    EXPECT_EQ(site_of("urn:ogc:def:crs,crs:EPSG:6.12:25833,crs:EPSG:6.12:5783", "368000 5808000").crs_code,
              "EPSG:25833+5783");
    const Georeference adv = site_of("urn:adv:crs:ETRS89_UTM32*DE_DHHN92_NH", "678000 5403000");
    EXPECT_EQ(adv.crs_code, "EPSG:25832+5783");
    ASSERT_TRUE(adv.site.has_value());
    EXPECT_NEAR(degrees_from_radians(adv.site->latitude_rad), 48.76, 0.01);  // Ingolstadt
    EXPECT_EQ(site_of("urn:adv:crs:DE_DHDN_3GK4*DE_DHHN2016_NH", "4468000 5333000").crs_code, "EPSG:31468+7837");
    const Georeference plateau = site_of("http://www.opengis.net/def/crs/EPSG/0/6697", "35.68 139.72");
    ASSERT_TRUE(plateau.site.has_value());
    EXPECT_NEAR(degrees_from_radians(plateau.site->longitude_rad), 139.72, 0.001);
}

TEST(ReadCityGml, TwoSystemsInOneFileAreTold) {
    const std::string envelope =
        "<gml:boundedBy><gml:Envelope srsName=\"urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783\"/></gml:boundedBy>";
    const auto document = [&](const std::string& name) {
        return gml_document(envelope + gml_building("<bldg:lod1MultiSurface><gml:MultiSurface srsName=\"" + name +
                                                    "\">" + surface_member(polygon(kFaces[1])) +
                                                    "</gml:MultiSurface></bldg:lod1MultiSurface>"));
    };
    EXPECT_EQ(load_gml(document("EPSG:25832")).findings.count("SB306"), 0u);
    EXPECT_EQ(load_gml(document("EPSG:25833")).findings.count("SB306"), 1u);
}

TEST(ReadCityGml, ExtensionsAndGroups) {
    const LoadedCity city = load_gml(gml_document(
        member("<ext:Kiosk gml:id=\"k\"><ext:lod2Solid>" + gml_solid(cube_members()) + "</ext:lod2Solid></ext:Kiosk>") +
        gml_building("<bldg:lod2Solid>" + gml_solid(cube_members()) +
                     "</bldg:lod2Solid><ext:more><ext:Detail><ext:lod2Solid>" + gml_solid(cube_members()) +
                     "</ext:lod2Solid></ext:Detail></ext:more>") +
        member("<grp:CityObjectGroup gml:id=\"g\"><grp:groupMember xlink:href=\"#b\"/></grp:CityObjectGroup>")));
    EXPECT_EQ(object_of(city, "k").type, ObjectType::generic);
    EXPECT_EQ(city.findings.count("SB105"), 1u);
    EXPECT_EQ(city.summary.surfaces, 12u);
    EXPECT_EQ(object_of(city, "b").parent_id, "");
}

}  // namespace
}  // namespace skybake
