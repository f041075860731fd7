// The folder of a bake: complete, equal bit by bit when read back, equal byte by byte when written again, and never
// half a bake.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Imath/half.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "io/exr/exr.h"
#include "io/file/replace_file.h"
#include "io/image/image.h"
#include "io/manifest/read_bake.h"
#include "io/manifest/sha256.h"
#include "io/manifest/web_pages.h"
#include "io/manifest/write_bake.h"
#include "scratch_folder.h"
#include "small_bake.h"
#include "json_schema.h"

namespace skybake::io {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string text_of(const std::filesystem::path& path) {
    const std::vector<std::uint8_t> bytes = read_file(path);
    return {bytes.begin(), bytes.end()};
}

void put(const std::filesystem::path& path, const std::string& text) {
    FileReplacement file(path);
    file.write(text);
    file.commit();
}

class BakeFolder : public ::testing::Test {
  protected:
    ScratchFolder folder{"bake"};
    SmallBake bake;
    BakeDescription description;
    BakeReport report;
    FindingLog findings;

    void SetUp() override {
        write_png(folder / "ground.png", {2, 2, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}});
        put(folder / "town.city.json", "abc");
        bake = make_small_bake(folder / "ground.png");
        description.version = "9.9";
        description.title = "town";
        description.crs = "EPSG:31256";
        description.site = Site{radians_from_degrees(47.0), radians_from_degrees(15.0), 350.0};
        description.sampling = "hierarchical";
        description.isa = "avx2";
        description.settings = {{"--texel", "0.5"}};
        description.inputs = {folder / "town.city.json"};
        description.views = {{"street", {1, 2, 3}, {4, 5, 6}}};
        for (std::size_t i = 0; i < bake.light.instants.size(); ++i) {
            InstantDescription instant;
            instant.sky_model = "uniform:luminance=3000";
            instant.sky_panorama.assign(std::size_t{kPanoramaWidth} * kPanoramaHeight, Rgb(3000.0f, 2000.0f, 1000.0f));
            instant.land_luminance = Rgb(4000.0f);
            if (i == 0) instant.air = air_under(bake.light.instants[i].daylight, 4, 6);
            description.instants.push_back(instant);
        }
        description.instants[0].utc = "2026-06-21T10:00:00Z";
        findings.add({"SB203", Severity::warning, "town.city.json: #/x", "ring crosses itself; left out.",
                      "Repair the ring.", 1});
        report.texels = 1234;
        report.seconds.total = 5.0;
    }
    WrittenBake write(const std::string& name) {
        SilentProgress progress;
        return write_bake(folder / name, {bake.scene, bake.atlas, bake.light, description, report, findings}, progress);
    }
};

TEST_F(BakeFolder, LightComesBackBitForBit) {
    write("a");
    const StoredBake stored = open_bake(folder / "a");
    ASSERT_EQ(stored.pages.size(), 2u);
    ASSERT_EQ(stored.instants.size(), 2u);
    EXPECT_EQ(stored.charts, 4u);
    EXPECT_EQ(stored.texel_m, 0.5);
    EXPECT_EQ(stored.instants[1].label, "sun 180,45");
    for (std::size_t p = 0; p < 2; ++p) {
        const LightmapPage base = read_base(stored, p);
        EXPECT_EQ(base.state, bake.light.pages[p].state);
        EXPECT_EQ(base.sky_view_factor, bake.light.pages[p].sky_view_factor);
        for (std::size_t t = 0; t < base.state.size(); ++t) {
            if (base.state[t] != TexelState::empty) {
                ASSERT_EQ(base.chart[t], bake.light.pages[p].chart[t]);
            }
        }
        for (std::size_t i = 0; i < 2; ++i) {
            const StoredLight light = read_light(stored, i, p);
            EXPECT_EQ(light.sky, bake.light.instants[i].pages[p].sky);
            for (std::size_t t = 0; t < light.total.size(); ++t) {
                ASSERT_EQ(light.total[t], total_irradiance(bake.light, i, p, t));
                ASSERT_EQ(light.sun[t], bake.light.instants[i].pages[p].sun_cosine[t] *
                                            bake.light.instants[i].daylight.sun.normal_illuminance);
            }
        }
    }
}

TEST_F(BakeFolder, ObjectsSayWhoseChartItIs) {
    bake.scene.objects = {{"house-1", "house", ObjectType::building_part}, {"road", "road", ObjectType::road}};
    bake.scene.faces[0].object = 1;
    bake.scene.faces[0].type = SurfaceType::road;
    description.attributes = {{"house", R"({"storeys": 3, "name": "Zum „Bären“"})"}, {"road", "no JSON"}};
    write("a");
    std::ifstream file(folder / "a/objects.json");
    const nlohmann::json json = nlohmann::json::parse(file);
    ASSERT_EQ(json["objects"].size(), 3u);  // the house has no surface of its own, but its part has
    const auto owner = [&](int chart) { return json["objects"][json["chart_objects"][chart].get<std::size_t>()]; };
    EXPECT_EQ(owner(0)["id"], "road");
    EXPECT_FALSE(owner(0).contains("attributes"));
    EXPECT_EQ(json["surface_types"][json["chart_surfaces"][0].get<std::size_t>()], "road");
    EXPECT_EQ(owner(1)["id"], "house-1");
    EXPECT_EQ(owner(1)["type"], "building_part");
    const nlohmann::json building = json["objects"][owner(1)["part_of"].get<std::size_t>()];
    EXPECT_EQ(building["id"], "house");
    EXPECT_EQ(building["attributes"]["name"], "Zum „Bären“");
    const nlohmann::json manifest = nlohmann::json::parse(std::ifstream(folder / "a/manifest.json"));
    EXPECT_EQ(manifest["objects"]["uri"], "objects.json");
}

// The browser's pictures, decoded as it does: sRGB or linear, times the scale of the chart. An 8-bit code is off by
// half a step at most; near 1 a step of sRGB is 1/255 × d(linear)/d(sRGB) = 2.28/255, so half of it is 0.0045 of the
// scale.
TEST_F(BakeFolder, WebPicturesHoldTheLightWithinHalfACode) {
    write("a");
    for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<std::uint8_t> bytes = read_file(folder / ("a/light/i" + std::to_string(i) + "_scales.bin"));
        ASSERT_EQ(bytes.size(), 4 * 2 * sizeof(float));
        std::array<float, 8> scales{};
        std::memcpy(scales.data(), bytes.data(), bytes.size());
        for (std::size_t p = 0; p < 2; ++p) {
            const std::string prefix = "a/light/i" + std::to_string(i) + "_p" + std::to_string(p);
            const Image8 sky = read_image(folder / (prefix + "_sky.png"));
            const Image8 sun = read_image(folder / (prefix + "_sun.png"));
            ASSERT_EQ(sky.channels, 3);
            ASSERT_EQ(sun.channels, 1);
            const LightmapPage& page = bake.light.pages[p];
            ASSERT_EQ(sky.width, page.width);
            ASSERT_EQ(sky.height, page.height);
            for (std::size_t t = 0; t < page.state.size(); ++t) {
                if (page.state[t] == TexelState::empty) continue;
                const float sky_scale = scales[2 * page.chart[t].index()];
                const float sun_scale = scales[2 * page.chart[t].index() + 1];
                for (int c = 0; c < 3; ++c) {
                    const float linear =
                        linear_from_srgb(static_cast<float>(sky.pixels[3 * t + static_cast<std::size_t>(c)]) / 255.0f);
                    ASSERT_NEAR(linear * sky_scale, 1e-3f * bake.light.instants[i].pages[p].sky[t][c],
                                0.0046f * sky_scale);
                }
                ASSERT_NEAR(static_cast<float>(sun.pixels[t]) / 255.0f * sun_scale,
                            bake.light.instants[i].pages[p].sun_cosine[t], 0.501f / 255.0f * sun_scale);
            }
        }
    }
}

// Lamps: once a page, in the total of every instant, and in the browser's picture within half a code.
TEST_F(BakeFolder, LampsStandWithTheirPages) {
    double sum = 0.0, squares = 0.0, total = 0.0, count = 0.0;
    for (std::size_t p = 0; p < 2; ++p) {
        LightmapPage& page = bake.light.pages[p];
        page.lamps.assign(page.state.size(), Rgb(0.0f));
        for (std::size_t t = 0; t < page.state.size(); ++t) {
            if (page.state[t] != TexelState::empty) page.lamps[t] = static_cast<float>(t % 7) * Rgb(3.0f, 2.0f, 0.5f);
            if (page.state[t] != TexelState::chart) continue;
            const double lx = static_cast<double>(luminance(page.lamps[t]));
            sum += lx;
            squares += lx * lx;
            total += static_cast<double>(luminance(total_irradiance(bake.light, 0, p, t)));
            count += 1.0;
        }
    }
    EXPECT_NEAR(exposure_hint(bake.light, 0), 0.5 * kPi * 1000.0 / (total / count + squares / sum), 1e-6);
    write("a");
    const std::vector<std::uint8_t> bytes = read_file(folder / "a/light/lamp_scales.bin");
    std::array<float, 4> scales{};
    ASSERT_EQ(bytes.size(), sizeof(scales));
    std::memcpy(scales.data(), bytes.data(), bytes.size());
    const StoredBake stored = open_bake(folder / "a");
    for (std::size_t p = 0; p < 2; ++p) {
        const LightmapPage& page = bake.light.pages[p];
        const Image8 lamps = read_image(folder / ("a/light/p" + std::to_string(p) + "_lamps.png"));
        const StoredLight light = read_light(stored, 1, p);
        std::vector<float> red(page.state.size());
        ExrReader reader(folder / ("a/light/p" + std::to_string(p) + "_base.exr"));
        reader.read(std::vector<ExrReader::Target>{{{"lamps.R", ExrType::float32}, red.data(), 1}});
        for (std::size_t t = 0; t < page.state.size(); ++t) {
            ASSERT_EQ(red[t], page.lamps[t].x);
            if (page.state[t] == TexelState::empty) continue;
            ASSERT_EQ(light.total[t], total_irradiance(bake.light, 1, p, t));
            const float scale = scales[page.chart[t].index()];
            ASSERT_NEAR(linear_from_srgb(static_cast<float>(lamps.pixels[3 * t]) / 255.0f) * scale,
                        1e-3f * page.lamps[t].x, 0.0046f * scale);
        }
    }
}

// The table of the encoder against the formula of IEC 61966-2-1, over the whole range.
TEST_F(BakeFolder, SrgbCodesAreTheNearest) {
    Lightmaps light;
    LightmapPage page{4000, 1, std::vector<TexelState>(4000, TexelState::chart), std::vector<ChartId>(4000),
                      std::vector<float>(4000)};
    BakedInstant instant;
    LightmapLayer layer;
    for (int t = 0; t < 4000; ++t) {
        const float share = static_cast<float>(t) / 3999.0f;
        layer.sky.push_back(Rgb(1000.0f * share * share));
        layer.sun_cosine.push_back(0.0f);
    }
    instant.pages = {layer};
    light.pages = {page};
    light.instants = {instant};
    const std::vector<ChartScale> scales = chart_scales(light, 0, 1);
    EXPECT_FLOAT_EQ(scales[0].sky_klx, 1.0f);
    const Image8 image = sky_picture(light, 0, 0, scales);
    for (std::size_t t = 0; t < 4000; ++t) {
        const float exact = 255.0f * srgb_from_linear(1e-3f * layer.sky[t].x);
        ASSERT_NEAR(static_cast<float>(image.pixels[3 * t]), exact, 0.501f) << t;
    }
    EXPECT_EQ(image.pixels.back(), 255);
}

TEST_F(BakeFolder, PanoramaIsHalfFloatsInKilocandelas) {
    write("a");
    const std::vector<std::uint8_t> bytes = read_file(folder / "a/light/i0_sky.bin");
    ASSERT_EQ(bytes.size(), std::size_t{kPanoramaWidth} * kPanoramaHeight * 8);
    std::array<std::uint16_t, 4> pixel{};
    std::memcpy(pixel.data(), bytes.data(), 8);
    const std::array<float, 4> expected = {3.0f, 2.0f, 1.0f, 1.0f};
    for (std::size_t c = 0; c < 4; ++c) {
        Imath::half value;
        value.setBits(pixel[c]);
        EXPECT_EQ(static_cast<float>(value), expected[c]);
    }
    EXPECT_EQ(half_from_float(1e9f), 0x7bff);  // the largest finite half
    EXPECT_EQ(half_from_float(std::numeric_limits<float>::infinity()), 0x7bff);
    EXPECT_EQ(half_from_float(std::nanf("")), 0);
    EXPECT_EQ(half_from_float(-1.0f), 0xbc00);
}

// The hint's own definition: 0.5 over the mean luminance of white on the texels of charts.
TEST_F(BakeFolder, ExposureHintBringsMeanWhiteToOneHalf) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t p = 0; p < 2; ++p) {
        for (std::size_t t = 0; t < bake.light.pages[p].state.size(); ++t) {
            if (bake.light.pages[p].state[t] != TexelState::chart) continue;
            sum += static_cast<double>(luminance(total_irradiance(bake.light, 0, p, t))) / kPi / 1000.0;
            count += 1.0;
        }
    }
    EXPECT_NEAR(exposure_hint(bake.light, 0) * sum / count, 0.5, 1e-6);
    for (BakedInstant& instant : bake.light.instants) {
        for (LightmapLayer& layer : instant.pages) {
            std::fill(layer.sky.begin(), layer.sky.end(), Rgb(0.0f));
            std::fill(layer.sun_cosine.begin(), layer.sun_cosine.end(), 0.0f);
        }
    }
    EXPECT_EQ(exposure_hint(bake.light, 0), 1.0);
}

TEST_F(BakeFolder, ManifestSaysWhatWasBakedAndListsEveryFile) {
    const WrittenBake written = write("a");
    const nlohmann::json m = nlohmann::json::parse(text_of(folder / "a/manifest.json"));
    EXPECT_EQ(m["format"], "skybake-bake");
    EXPECT_EQ(m["version"], 1);
    EXPECT_EQ(m["generator"], nlohmann::json({{"name", "skybake"}, {"version", "9.9"}}));
    EXPECT_EQ(m["origin"], nlohmann::json({-67000.0, 215000.0, 350.0}));
    EXPECT_NEAR(m["site"]["latitude_deg"].get<double>(), 47.0, 1e-12);
    EXPECT_EQ(m["bounds"]["max"], nlohmann::json({20.0, 16.0, 6.0}));
    // FIPS 180-2, appendix B.1: the digest of "abc".
    EXPECT_EQ(m["inputs"], nlohmann::json::array(
                               {{{"file", "town.city.json"},
                                 {"bytes", 3},
                                 {"sha256", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"}}}));
    EXPECT_EQ(m["instants"][0]["utc"], "2026-06-21T10:00:00Z");
    EXPECT_FALSE(m["instants"][1].contains("utc"));
    // Direction (0, −1, 1): due south, 45° high.
    EXPECT_NEAR(m["instants"][0]["sun"]["azimuth_deg"].get<double>(), 180.0, 1e-4);
    EXPECT_NEAR(m["instants"][0]["sun"]["elevation_deg"].get<double>(), 45.0, 1e-4);
    EXPECT_EQ(m["instants"][0]["sun"]["normal_illuminance_klx"], nlohmann::json({90.0, 85.0, 80.0}));
    EXPECT_EQ(m["findings"][0]["code"], "SB203");
    EXPECT_EQ(m["settings"], nlohmann::json({{"--texel", "0.5"}}));
    EXPECT_FALSE(m["report"].contains("seconds"));  // would differ from run to run

    std::set<std::string> listed;
    for (const nlohmann::json& file : m["files"]) {
        listed.insert(file["name"].get<std::string>());
        EXPECT_EQ(file["bytes"].get<std::uint64_t>(),
                  std::filesystem::file_size(folder / "a" / file["name"].get<std::string>()));
    }
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "a")) {
        if (entry.is_regular_file()) found.insert(std::filesystem::relative(entry.path(), folder / "a").string());
    }
    found.erase("manifest.json");
    EXPECT_EQ(listed, found);
    EXPECT_EQ(written.files, listed.size());
    EXPECT_THAT(text_of(folder / "a/manifest.json"), ::testing::Not(HasSubstr(folder.path().string())));
}

TEST_F(BakeFolder, ManifestFitsItsSchema) {
    write("a");
    const nlohmann::json schema = nlohmann::json::parse(text_of(SKYBAKE_SCHEMA_FOLDER "/manifest.schema.json"));
    check_schema(schema, schema, nlohmann::json::parse(text_of(folder / "a/manifest.json")), "manifest");
    description.site.reset();
    write("b");
    check_schema(schema, schema, nlohmann::json::parse(text_of(folder / "b/manifest.json")), "manifest");
}

TEST_F(BakeFolder, SameBytesForAnyNumberOfThreadsAndAnyDuration) {
    write("many");
    report.seconds.total = 77.0;
    report.peak_rss_bytes = 5;
    {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        write("one");
    }
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "many")) {
        if (!entry.is_regular_file()) continue;
        const std::filesystem::path relative = std::filesystem::relative(entry.path(), folder / "many");
        EXPECT_EQ(read_file(entry.path()), read_file(folder / "one" / relative.string())) << relative;
        ++count;
    }
    // 2 × (scales, panorama), air, 2 × (base, svf), 4 × (exr, sky, sun), city.glb, objects.json, manifest.json
    EXPECT_EQ(count, 24u);
}

// A stopped bake leaves no manifest, neither its own nor the old one's, and what it left is gone after the next.
TEST_F(BakeFolder, StoppedBakeIsNoBake) {
    struct StopAtOnce final : Progress {
        void begin(std::string_view, std::uint64_t) override {}
        void advance(std::uint64_t) override {}
        bool stop_requested() const override { return true; }
    };
    write("a");
    put(folder / "a/light/i7_p9_sun.png", "of an older and larger bake");
    put(folder / "a/light/i0_p0.exr.part", "of a killed bake");
    put(folder / "a/light/notes.txt", "of the user");
    put(folder / "a/index.html", "of the viewer");
    StopAtOnce stop;
    EXPECT_THROW(write_bake(folder / "a", {bake.scene, bake.atlas, bake.light, description, report, findings}, stop),
                 Interrupted);
    EXPECT_FALSE(std::filesystem::exists(folder / "a/manifest.json"));
    EXPECT_THAT([&] { open_bake(folder / "a"); }, ThrowsMessage<InputError>(HasSubstr("holds no whole bake")));
    write("a");
    EXPECT_NO_THROW(open_bake(folder / "a"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a/light/i7_p9_sun.png"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a/light/i0_p0.exr.part"));
    EXPECT_TRUE(std::filesystem::exists(folder / "a/light/notes.txt"));
    EXPECT_TRUE(std::filesystem::exists(folder / "a/index.html"));
}

TEST_F(BakeFolder, InputThatIsGoneLeavesNoManifest) {
    description.inputs = {folder / "gone.json"};
    EXPECT_THAT([&] { write("a"); }, ThrowsMessage<InputError>(HasSubstr("gone.json: cannot be read")));
    EXPECT_FALSE(std::filesystem::exists(folder / "a/manifest.json"));
}

TEST_F(BakeFolder, BrokenBakesAreRefusedByName) {
    EXPECT_THAT([&] { open_bake(folder / "none"); }, ThrowsMessage<InputError>(HasSubstr("is no folder")));
    EXPECT_THAT([&] { open_bake(folder.path()); }, ThrowsMessage<InputError>(HasSubstr("holds no whole bake")));
    write("a");
    const std::string whole = text_of(folder / "a/manifest.json");
    const auto with = [&](const std::string& old, const std::string& now) {
        std::string text = whole;
        text.replace(text.find(old), old.size(), now);
        put(folder / "a/manifest.json", text);
    };
    with("skybake-bake", "something-else");
    EXPECT_THAT([&] { open_bake(folder / "a"); }, ThrowsMessage<InputError>(HasSubstr("is not of a bake of skybake")));
    with("\"version\": 1", "\"version\": 2");
    EXPECT_THAT([&] { open_bake(folder / "a"); }, ThrowsMessage<InputError>(HasSubstr("has version 2")));
    with("\"charts\": 4", "\"charts\": \"four\"");
    EXPECT_THAT([&] { open_bake(folder / "a"); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("manifest.json: is no manifest of a bake"))));
    with("light/p0_base.exr", "../../p0_base.exr");
    EXPECT_THAT([&] { open_bake(folder / "a"); }, ThrowsMessage<InputError>(HasSubstr("outside its folder")));
    put(folder / "a/manifest.json", whole.substr(0, whole.size() / 2));
    EXPECT_THAT([&] { open_bake(folder / "a"); }, ThrowsMessage<InputError>(HasSubstr("is no manifest of a bake")));
    with("\"width\": 48", "\"width\": 47");
    EXPECT_THAT([&] { read_base(open_bake(folder / "a"), 0); },
                ThrowsMessage<InputError>(HasSubstr("the manifest says 47 x 40")));
    with("\"charts\": 4", "\"charts\": 3");
    EXPECT_THAT([&] { read_base(open_bake(folder / "a"), 1); },
                ThrowsMessage<InputError>(HasSubstr("names chart 3 of 3")));
}

}  // namespace
}  // namespace skybake::io
