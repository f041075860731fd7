// Materials and textures of CityGML. Truth: the specification's clause 9 and coordinates worked out by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gml_text.h"

namespace skybake {
namespace {

using testing::HasSubstr;

const std::string kRoof = "0 0 3 4 0 3 4 2 3 0 2 3 0 0 3";

std::string roof_building() {
    return gml_building("<bldg:lod2MultiSurface><gml:MultiSurface gml:id=\"ms\">" +
                        surface_member(polygon(kRoof, "p")) + "</gml:MultiSurface></bldg:lod2MultiSurface>");
}
std::string appearance(const std::string& data, const std::string& theme = "summer") {
    return "<app:appearanceMember><app:Appearance><app:theme>" + theme + "</app:theme><app:surfaceDataMember>" + data +
           "</app:surfaceDataMember></app:Appearance></app:appearanceMember>\n";
}
std::string parameterized(const std::string& coordinates, const std::string& more = "") {
    return "<app:ParameterizedTexture><app:imageURI>t/roof.png</app:imageURI>" + more +
           "<app:target uri=\"#p\"><app:TexCoordList><app:textureCoordinates ring=\"#r-p\">" + coordinates +
           "</app:textureCoordinates></app:TexCoordList></app:target></app:ParameterizedTexture>";
}
/// A PNG's head that states 40 × 20 pixels.
std::string png_head() {
    std::string head("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x28\0\0\0\x14", 24);
    return head;
}

struct Loaded {
    TemporaryFolder folder;
    LoadedCity city;
    explicit Loaded(const std::string& members) {
        folder.write("t/roof.png", png_head());
        city = load(folder.write("a.gml", gml_document(members)));
    }
    /// The texture coordinates at a corner of the only surface.
    Vec2f uv_at(const Vec3d& p) const {
        const Geometry& g = city.city.objects[0].geometry;
        for (std::size_t i = 0; i < g.corners.size(); ++i) {
            if (g.vertices[g.corners[i]] == p && !g.corner_uv.empty()) return g.corner_uv[i];
        }
        return Vec2f(-99.0f);
    }
    bool is_textured() const { return city.city.objects[0].geometry.surfaces[0].texture.has_value(); }
};

TEST(GmlAppearance, ATextureLiesAsItsCoordinatesSay) {
    const Loaded loaded(roof_building() +
                        appearance(parameterized("0 0 2 0 2 1 0 1 0 0", "<app:wrapMode>mirror</app:wrapMode>")));
    ASSERT_TRUE(loaded.is_textured());
    EXPECT_EQ(loaded.uv_at({4, 2, 3}), Vec2f(2, 1));
    EXPECT_EQ(loaded.uv_at({0, 2, 3}), Vec2f(0, 1));
    ASSERT_EQ(loaded.city.city.textures.size(), 1u);
    EXPECT_EQ(loaded.city.city.textures[0].wrap, TextureWrap::mirror);
    EXPECT_FALSE(loaded.city.city.textures[0].is_missing);
}

TEST(GmlAppearance, CoordinatesWithoutTheRepeatedCornerFitToo) {
    const Loaded loaded(appearance(parameterized("0 0 1 0 1 1 0 1")) + roof_building());
    EXPECT_EQ(loaded.uv_at({4, 2, 3}), Vec2f(1, 1)) << "appearances may come first";
    const Loaded misfit(roof_building() + appearance(parameterized("0 0 1 0 1 1")));
    EXPECT_FALSE(misfit.is_textured());
    EXPECT_THAT(finding_text(misfit.city, "SB403"), HasSubstr("a ring has 5 positions and 3 texture coordinates"));
    const Loaded text(roof_building() + appearance(parameterized("0 0 1 zero 1 1 0 1")));
    EXPECT_EQ(text.city.findings.count("SB403"), 1u);
}

TEST(GmlAppearance, AReversedSurfaceKeepsItsTextureInPlace) {
    const std::string reversed = gml_building(
        "<bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember><gml:OrientableSurface orientation=\"-\">"
        "<gml:baseSurface>" +
        polygon("0 0 3 0 2 3 4 2 3 4 0 3 0 0 3", "p") +
        "</gml:baseSurface></gml:OrientableSurface></gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface>");
    const Loaded loaded(reversed + appearance(parameterized("0 0 0 1 2 1 2 0 0 0")));
    EXPECT_EQ(loaded.uv_at({4, 2, 3}), Vec2f(2, 1));
    EXPECT_EQ(loaded.uv_at({4, 0, 3}), Vec2f(2, 0));
    EXPECT_EQ(loaded.uv_at({0, 2, 3}), Vec2f(0, 1));
}

TEST(GmlAppearance, Version3NamesRingsInElements) {
    const Loaded loaded(
        roof_building() +
        appearance("<app:ParameterizedTexture><app:imageURI>t/roof.png</app:imageURI>"
                   "<app:textureParameterization><app:TextureAssociation><app:target>#p</app:target>"
                   "<app:textureParameterization><app:TexCoordList><app:textureCoordinates>0 0 1 0 1 1 0 1 "
                   "0 0</app:textureCoordinates><app:ring>#r-p</app:ring></app:TexCoordList>"
                   "</app:textureParameterization></app:TextureAssociation>"
                   "</app:textureParameterization></app:ParameterizedTexture>"));
    EXPECT_EQ(loaded.uv_at({4, 2, 3}), Vec2f(1, 1));
}

TEST(GmlAppearance, AMatrixProjectsATexture) {
    const Loaded loaded(roof_building() +
                        appearance("<app:ParameterizedTexture><app:imageURI>t/roof.png</app:imageURI><app:target "
                                   "uri=\"#ms\"><app:TexCoordGen><app:worldToTexture>0.25 0 0 0 0 0.5 0 0.5 0 0 0 1"
                                   "</app:worldToTexture></app:TexCoordGen></app:target></app:ParameterizedTexture>"));
    EXPECT_EQ(loaded.uv_at({4, 2, 3}), Vec2f(1, 1.5)) << "the set's texture is the texture of all in it";
}

TEST(GmlAppearance, AGeoreferencedImageLiesOnTheMap) {
    // 40 × 20 pixels of 0.1 m, the centre of the upper left one at (0.05, 1.95): the image covers the roof exactly.
    const std::string georeferenced =
        "<app:GeoreferencedTexture><app:imageURI>t/roof.png</app:imageURI><app:referencePoint><gml:Point>"
        "<gml:pos>0.05 1.95</gml:pos></gml:Point></app:referencePoint><app:orientation>0.1 0 0 -0.1</app:orientation>"
        "<app:target>#p</app:target></app:GeoreferencedTexture>";
    const Loaded loaded(roof_building() + appearance(georeferenced));
    const auto is_near = [&](const Vec3d& p, const Vec2f& uv) {
        EXPECT_NEAR(loaded.uv_at(p).x, uv.x, 1e-6);
        EXPECT_NEAR(loaded.uv_at(p).y, uv.y, 1e-6);
    };
    is_near({0, 0, 3}, {0, 0});
    is_near({4, 0, 3}, {1, 0});
    is_near({4, 2, 3}, {1, 1});
    const Loaded nowhere(roof_building() +
                         appearance("<app:GeoreferencedTexture><app:imageURI>t/roof.png</app:imageURI>"
                                    "<app:target>#p</app:target></app:GeoreferencedTexture>"));
    EXPECT_FALSE(nowhere.is_textured());
    EXPECT_EQ(nowhere.city.findings.count("SB403"), 1u);
}

TEST(GmlAppearance, MaterialsAreTheirSurfacesAlbedo) {
    const Loaded loaded(
        roof_building() +
        appearance("<app:X3DMaterial><app:diffuseColor>1 0 0</app:diffuseColor><app:transparency>0.5"
                   "</app:transparency><app:isFront>false</app:isFront><app:target>#p</app:target>"
                   "</app:X3DMaterial>") +
        appearance("<app:X3DMaterial><app:diffuseColor>0 1 0</app:diffuseColor><app:target>#p</app:target>"
                   "</app:X3DMaterial>"));
    const Surface& surface = loaded.city.city.objects[0].geometry.surfaces[0];
    ASSERT_TRUE(surface.material.has_value());
    EXPECT_EQ(loaded.city.city.materials[surface.material->index()].albedo, Rgb(0, 1, 0)) << "the front counts";
    EXPECT_EQ(loaded.city.findings.count("SB406"), 1u);
}

TEST(GmlAppearance, OneThemeIsUsed) {
    const Loaded loaded(roof_building() + appearance(parameterized("0 0 1 0 1 1 0 1 0 0")) +
                        appearance(parameterized("9 9 8 9 8 8 9 8 9 9"), "winter"));
    EXPECT_EQ(loaded.uv_at({4, 2, 3}), Vec2f(1, 1));
    EXPECT_THAT(finding_text(loaded.city, "SB407"), HasSubstr("textures have 2 themes; 'summer' is used"));
}

TEST(GmlAppearance, ImagesOutsideTheFolderAreRefused) {
    for (const std::string path : {"../roof.png", "/etc/roof.png", "t/../../roof.png", "..\\roof.png"}) {
        std::string data = parameterized("0 0 1 0 1 1 0 1 0 0");
        data.replace(data.find("t/roof.png"), 10, path);
        EXPECT_EQ(Loaded(roof_building() + appearance(data)).city.findings.count("SB402"), 1u) << path;
    }
    std::string remote = parameterized("0 0 1 0 1 1 0 1 0 0");
    remote.replace(remote.find("t/roof.png"), 10, "http://x/roof.png");
    EXPECT_EQ(Loaded(roof_building() + appearance(remote)).city.findings.count("SB401"), 1u);
}

}  // namespace
}  // namespace skybake
