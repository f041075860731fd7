// `skybake render` as a program: a street of boxes under an even sky, from a city file to the picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/exr/exr.h"
#include "io/image/image.h"
#include "run_program.h"

namespace skybake {
namespace {

using testing::HasSubstr;

/// A level square of 40 m with albedo 0.3 by default, under an even sky of 1000 cd/m²: E = π · 1000 lx everywhere.
class RenderVerb : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new TemporaryFolder;
        std::ofstream(*folder_ / "square.city.json") << nlohmann::json{
            {"type", "CityJSON"},
            {"version", "2.0"},
            {"metadata", {{"referenceSystem", "https://www.opengis.net/def/crs/EPSG/0/31256"}}},
            {"transform", {{"scale", {1, 1, 1}}, {"translate", {0, 340000, 100}}}},
            {"CityObjects",
             {{"ground",
               {{"type", "TINRelief"},
                {"geometry",
                 {{{"type", "CompositeSurface"}, {"lod", "1"}, {"boundaries", {{{0, 1, 2}}, {{0, 2, 3}}}}}}}}}}},
            {"vertices",
             {{0, 0, 0},
              {40, 0, 0},
              {40, 40, 0},
              {0, 40, 0}}}}.dump();
        Running bake(*folder_, {"bake", folder_->str("square.city.json"), "-o", folder_->str("lit"), "--sun-direction",
                                "180,45", "--sun", "point", "--sky", "uniform:luminance=1000", "--texel", "1"});
        ASSERT_EQ(bake.exit_code(), 0) << bake.err();
        manifest_ = nlohmann::json::parse(text_of(*folder_ / "lit/manifest.json"));
    }
    static void TearDownTestSuite() { delete folder_; }

    static int render(std::vector<std::string> arguments, std::string* err = nullptr, std::string* out = nullptr) {
        arguments.insert(arguments.begin(), {"render", folder_->str("lit"), "--quiet"});
        Running run(*folder_, arguments);
        const int code = run.exit_code();
        if (err) *err = run.err();
        if (out) *out = run.out();
        return code;
    }

    static inline TemporaryFolder* folder_ = nullptr;
    static inline nlohmann::json manifest_;
};

TEST_F(RenderVerb, TheSquareShowsItsLightInEachPart) {
    const auto klx = manifest_["instants"][0]["sun"]["normal_illuminance_klx"].get<std::array<double, 3>>();
    for (const auto& [parts, sky, sun] : {std::tuple{"", 1.0, 1.0}, {"sky", 1.0, 0.0}, {"sun=0.5", 0.0, 0.5}}) {
        std::vector<std::string> arguments = {"-o",        folder_->str("lux.exr"), "--projection", "plan",
                                              "--picture", "illuminance",           "--size",       "64x32"};
        if (*parts != '\0') arguments.insert(arguments.end(), {"--parts", parts});
        std::string err;
        ASSERT_EQ(render(arguments, &err), 0) << err;
        const io::PictureRgb picture = io::read_exr_rgb(*folder_ / "lux.exr");
        ASSERT_EQ(picture.width, 64);
        const Rgb middle = picture.pixels[16 * 64 + 32];
        for (int c = 0; c < 3; ++c) {
            const double expected =
                sky * std::numbers::pi * 1000.0 + sun * std::sqrt(0.5) * 1000.0 * klx[static_cast<std::size_t>(c)];
            EXPECT_NEAR(middle[c], expected, 2e-3 * expected);  // the dome's quadrature
        }
        EXPECT_EQ(picture.pixels[0], Rgb(0.0f));  // beside the square
    }
}

TEST_F(RenderVerb, PicturesHaveTheirSizeAndTheirFurniture) {
    const std::string plain = folder_->str("plain.png"), full = folder_->str("full.png");
    std::string out;
    ASSERT_EQ(render({"-o", plain, "--projection", "plan", "--size", "400x300", "--plain"}), 0);
    ASSERT_EQ(render({"-o", full, "--projection", "plan", "--size", "400x300", "--json"}, nullptr, &out), 0);
    const io::Image8 a = io::read_image(plain), b = io::read_image(full);
    EXPECT_EQ(a.width, 400);
    EXPECT_EQ(a.height, 300);
    EXPECT_NE(a.pixels, b.pixels);
    const auto json = nlohmann::json::parse(out);
    EXPECT_NEAR(json["metres_per_pixel"].get<double>(), 1.06 * 40.0 * 4.0 / 3.0 / 400.0, 1e-3);
    EXPECT_EQ(json["parts"], (nlohmann::json{"sky", "sun"}));
    EXPECT_GT(json["seconds_per_megapixel"].get<double>(), 0.0);
    ASSERT_EQ(render({"-o", folder_->str("again.png"), "--projection", "plan", "--size", "400x300", "--plain",
                      "--threads", "1"}),
              0);
    EXPECT_EQ(text_of(plain), text_of(folder_->str("again.png")));
}

TEST_F(RenderVerb, TheLinkChoosesPlacePictureAndExposure) {
    const std::string link =
        "http://127.0.0.1:8080/"
        "?antialias=off#v=1&m=walk&p=0.00,-15.00,1.70&t=0.00%2C5.00,1.70&s=light&i=0&ev=-1.0&new=field";
    const std::string a = folder_->str("a.png"), b = folder_->str("b.png");
    std::string err;
    ASSERT_EQ(render({"-o", a, "--size", "64x36", "--camera", link}, &err), 0) << err;
    ASSERT_EQ(render({"-o", b, "--size", "64x36", "--camera", "#v=1&p=0,-15,1.7&t=0,5,1.7", "--picture", "light",
                      "--exposure", "-1"}),
              0);
    EXPECT_EQ(text_of(a), text_of(b));
    ASSERT_EQ(render({"-o", b, "--size", "64x36", "--camera", link, "--exposure", "1"}), 0);
    EXPECT_NE(text_of(a), text_of(b));
}

TEST_F(RenderVerb, ATimeMayBeWrittenInOtherWays) {
    Running bake(*folder_, {"bake", folder_->str("square.city.json"), "-o", folder_->str("noon"), "--at",
                            "2026-06-21T12:00Z,2026-06-21T13:00Z", "--texel", "4"});
    ASSERT_EQ(bake.exit_code(), 0) << bake.err();
    for (const auto& [at, code] : {std::pair{"2026-06-21T14:00+02:00", 0},
                                   {"2026-06-21 13:00:00Z", 0},
                                   {"2026-06-21T14:00Z", 2},
                                   {"2026-06-21", 2}}) {
        Running run(*folder_,
                    {"render", folder_->str("noon"), "-o", folder_->str("noon.png"), "--size", "16x16", "--at", at});
        EXPECT_EQ(run.exit_code(), code) << at;
    }
}

TEST_F(RenderVerb, SavedViewsAndInstantsHaveNames) {
    const std::string png = folder_->str("v.png");
    for (const auto& view : manifest_["views"])
        EXPECT_EQ(render({"-o", png, "--size", "16x16", "--view", view["name"]}), 0);
    EXPECT_EQ(render({"-o", png, "--size", "16x16", "--at", manifest_["instants"][0]["label"]}), 0);
    EXPECT_EQ(render({"-o", png, "--size", "32x16", "--projection", "panorama", "--at", "0"}), 0);
    EXPECT_EQ(render({"-o", png, "--size", "16x16", "--projection", "orthographic", "--picture", "sky-view"}), 0);
}

TEST_F(RenderVerb, WhatCannotBeDoneIsToldWithItsRemedy) {
    const std::string png = folder_->str("w.png");
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"-o", folder_->str("w.jpg")}, ".png or an .exr"},
        {{"-o", folder_->str("none/w.png")}, "no such folder"},
        {{"-o", png, "--size", "100000x10"}, "from 1 to 8192"},
        {{"-o", png, "--size", "100"}, "WIDTHxHEIGHT"},
        {{"-o", png, "--view", "Bird"}, "did you mean 'Bird's eye'"},
        {{"-o", png, "--picture", "lid"}, "did you mean 'lit'"},
        {{"-o", png, "--projection", "plane"}, "did you mean 'plan'"},
        {{"-o", png, "--parts", "sum"}, "did you mean 'sun'"},
        {{"-o", png, "--parts", "sun=-1"}, "no number of 0 or more"},
        {{"-o", png, "--at", "1999"}, "is none of the bake's instants"},
        {{"-o", png, "--camera", "#v=1&p=0,0,0"}, "Copy the link"},
        {{"-o", png, "--camera", "#v=1&p=0,0,0&t=0,0,x"}, "names no place"},
        {{"-o", png, "--camera", "#v=2&p=0,0,0&t=0,1,0"}, "another version"},
        {{"-o", png, "--camera", "#v=1&p=0,0,0&t=0,1,0&i=7"}, "the bake has 1"},
        {{"-o", png, "--range", "5,1"}, "from a lower to a higher"},
        {{"-o", png, "--range", "1,5"}, "only a .png of a measure"},
        {{"-o", folder_->str("w.exr"), "--exposure", "1"}, "an .exr keeps"},
        {{"-o", png, "--picture", "textures", "--exposure", "1"}, "shows no luminance"},
        {{"-o", png, "--picture", "sky-view", "--parts", "sun"}, "shows no light"},
        {{"-o", png, "--width", "30"}, "of orthographic pictures and plans"}};
    for (const auto& [arguments, message] : cases) {
        std::string err;
        EXPECT_EQ(render(arguments, &err), 2) << message;
        EXPECT_THAT(err, HasSubstr(message));
    }
    EXPECT_FALSE(std::filesystem::exists(png));
}

TEST_F(RenderVerb, ABrokenBakeIsNamed) {
    const std::filesystem::path copy = *folder_ / "broken";
    const auto fault_of = [&](const char* file) {
        std::filesystem::remove_all(copy);
        std::filesystem::copy(*folder_ / "lit", copy, std::filesystem::copy_options::recursive);
        std::filesystem::resize_file(copy / file, 100);
        Running run(*folder_, {"render", copy.string(), "-o", folder_->str("x.png"), "--size", "8x8"});
        EXPECT_EQ(run.exit_code(), 2) << file;
        return run.err();
    };
    for (const char* file : {"city.glb", "light/i0_p0.exr", "light/i0_sky.bin", "manifest.json"})
        EXPECT_THAT(fault_of(file), HasSubstr(file));
}

TEST_F(RenderVerb, ALinkMayAskForFalseColoursAndLieBetweenInstants) {
    std::string err, out;
    ASSERT_EQ(render({"-o", folder_->str("link.png"), "--size", "16x16", "--json", "--camera",
                      "#v=1&p=20,20,60&t=20,21,0&s=illuminance&fc=50,200000,log&i=0&f=0.25"},
                     &err, &out),
              0)
        << err;
    EXPECT_EQ(nlohmann::json::parse(out)["range"], nlohmann::json({50.0, 200000.0}));
    EXPECT_EQ(render({"-o", folder_->str("link.png"), "--camera", "#v=1&p=20,20,60&t=20,21,0&fc=9,1,lin"}, &err), 2);
    EXPECT_THAT(err, HasSubstr("range '9,1,lin'"));
    Running loud(*folder_, {"render", folder_->str("lit"), "-o", folder_->str("link.png"), "--size", "16x16",
                            "--camera", "#v=1&p=20,20,60&t=20,21,0&i=0&f=0.25"});
    EXPECT_EQ(loud.exit_code(), 0);
    EXPECT_THAT(loud.err(), HasSubstr("between two instants"));
}

TEST_F(RenderVerb, ALinkScalesPartsAndNamesLayersThatStillsDoNotDraw) {
    const std::string view = "#v=1&p=20,20,60&t=20,21,0&s=illuminance";
    const std::string a = folder_->str("scaled.png"), b = folder_->str("parts.png");
    std::string err;
    const auto both = [&](const std::string& link, const std::string& parts) {
        ASSERT_EQ(render({"-o", a, "--size", "16x16", "--camera", view + link}, &err), 0) << err;
        ASSERT_EQ(render({"-o", b, "--size", "16x16", "--camera", view, "--parts", parts}, &err), 0) << err;
        EXPECT_EQ(text_of(a), text_of(b)) << link;
    };
    both("&k=sun:0.50", "sun=0.5,sky");
    both("&k=sun:0.50,sky:2&off=sun", "sun=0,sky=2");
    EXPECT_EQ(render({"-o", a, "--camera", view + "&k=sun"}, &err), 2);
    EXPECT_THAT(err, HasSubstr("factor 'sun'"));
    const std::string layer = "#v=1&p=20,20,60&t=20,21,0&s=layer&l=sun_hours_2026-03-21";
    EXPECT_EQ(render({"-o", a, "--camera", layer}, &err), 2);
    EXPECT_THAT(err, HasSubstr("'sun_hours_2026-03-21'"));
    EXPECT_THAT(err, HasSubstr("--picture"));
    EXPECT_EQ(render({"-o", a, "--size", "16x16", "--camera", layer, "--picture", "lit"}, &err), 0) << err;
}

TEST_F(RenderVerb, ExportPaintsTheLightOntoTheCity) {
    Running run(*folder_, {"export", folder_->str("lit"), "-o", folder_->str("unlit.glb"), "--detail", "3", "--json"});
    ASSERT_EQ(run.exit_code(), 0) << run.err();
    const nlohmann::json json = nlohmann::json::parse(run.out());
    EXPECT_EQ(json["triangles"], 2);
    EXPECT_EQ(json["bytes"], std::filesystem::file_size(*folder_ / "unlit.glb"));
    Running far(*folder_, {"export", folder_->str("lit"), "-o", folder_->str("unlit.glb"), "--at", "noon"});
    EXPECT_EQ(far.exit_code(), 2);
    EXPECT_THAT(far.err(), HasSubstr("--at 'noon'"));
    Running named(*folder_, {"export", folder_->str("lit"), "-o", folder_->str("unlit.obj")});
    EXPECT_EQ(named.exit_code(), 2);
}

}  // namespace
}  // namespace skybake
