// The CSV contracts of the verb probe.
#include "io/points/points_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "scratch_folder.h"

namespace skybake::io {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class PointsCsv : public ::testing::Test {
  protected:
    ScratchFolder folder{"points"};
    std::vector<ProbePoint> read(const std::string& text) {
        FileReplacement file(folder / "p.csv");
        file.write(text);
        file.commit();
        return read_points(folder / "p.csv");
    }
};

TEST_F(PointsCsv, ReadsPointsAndMakesNormalsUnit) {
    const auto points = read("id,x,y,z,nx,ny,nz\na,1.5,-2,3e2,0,0,2\nb,-67000.25,215000.5,350,3,4,0\n");
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0].id, "a");
    EXPECT_EQ(points[0].position, Vec3d(1.5, -2.0, 300.0));
    EXPECT_EQ(points[0].normal, Vec3d(0, 0, 1));
    EXPECT_EQ(points[1].position, Vec3d(-67000.25, 215000.5, 350.0));
    EXPECT_NEAR(glm::distance(points[1].normal, Vec3d(0.6, 0.8, 0.0)), 0.0, 1e-15);
}

// What spreadsheets and other systems do to a CSV: byte order mark, CR LF, quotes, further columns, no last line end,
// empty lines.
TEST_F(PointsCsv, ReadsWhatSpreadsheetsWrite) {
    const auto points = read(
        "\xef\xbb\xbfid,x,y,z,nx,ny,nz,note\r\n\"a, \"\"b\"\"\", 1 ,2,3,0,0,1,\"two\nlines\"\r\n\r\nc,1,2,3,0,0,+1,");
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0].id, "a, \"b\"");
    EXPECT_EQ(points[1].id, "c");
}

TEST_F(PointsCsv, TinyAndHugeNormalsKeepTheirDirection) {
    const auto points = read("id,x,y,z,nx,ny,nz\na,0,0,0,0,1e-300,0\nb,0,0,0,-1e300,0,0\n");
    EXPECT_EQ(points[0].normal, Vec3d(0, 1, 0));
    EXPECT_EQ(points[1].normal, Vec3d(-1, 0, 0));
}

TEST_F(PointsCsv, FaultsAreNamedWithTheirLine) {
    const std::string header = "id,x,y,z,nx,ny,nz\n";
    EXPECT_THAT([&] { read(""); }, ThrowsMessage<InputError>(HasSubstr("p.csv: is empty")));
    EXPECT_THAT([&] { read("a,1,2,3,0,0,1\n"); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("line 1"), HasSubstr("column 1 must be 'id'"))));
    EXPECT_THAT([&] { read("id,x,y,z\n"); }, ThrowsMessage<InputError>(HasSubstr("column 5 must be 'nx'")));
    EXPECT_THAT([&] { read(header + "a,1,2,3,0,0,1\n\nb,1,2,3\n"); },
                ThrowsMessage<InputError>(HasSubstr("line 4: has 4 fields, not the 7")));
    EXPECT_THAT([&] { read(header + "a,1,2,x,0,0,1\n"); },
                ThrowsMessage<InputError>(HasSubstr("line 2: 'x' in column z is no number")));
    EXPECT_THAT([&] { read(header + "a,1,2,,0,0,1\n"); },
                ThrowsMessage<InputError>(HasSubstr("'' in column z is no number")));
    EXPECT_THAT([&] { read(header + "a,1,2 m,3,0,0,1\n"); },
                ThrowsMessage<InputError>(HasSubstr("'2 m' in column y is no number")));
    EXPECT_THAT([&] { read(header + "a,nan,2,3,0,0,1\n"); },
                ThrowsMessage<InputError>(HasSubstr("'nan' in column x is not finite")));
    EXPECT_THAT([&] { read(header + "a,1,2,3,0,-inf,1\n"); },
                ThrowsMessage<InputError>(HasSubstr("'-inf' in column ny is not finite")));
    EXPECT_THAT([&] { read(header + "a,1,2,3,0,0,0\n"); },
                ThrowsMessage<InputError>(HasSubstr("line 2: the normal of point 'a' has no length")));
    EXPECT_THAT([&] { read(header + "\"a,1,2,3,0,0,1\n"); }, ThrowsMessage<InputError>(HasSubstr("no closing quote")));
    EXPECT_THAT([&] { read(header + "\"a\"b,1,2,3,0,0,1\n"); },
                ThrowsMessage<InputError>(HasSubstr("behind the closing quote")));
}

TEST_F(PointsCsv, WritesTheContract) {
    const std::vector<ProbePoint> points = {{"a", {}, {}}, {"b, c", {}, {}}};
    const std::vector<ProbeLight> light = {{90000.0, 10000.5, 0.0, Rgb(100000.0f), 1.0, 0.25, 0.0}, {}};
    EXPECT_EQ(probe_csv(points, light),
              "id,sun_lx,sky_lx,indirect_lx,total_lx,total_r,total_g,total_b,sun_visible,sky_view_factor,lamps_lx,"
              "indirect_error_lx\n"
              "a,90000,10000.5,0,100000,100000,100000,100000,1,0.25,0,0\n"
              "\"b, c\",0,0,0,0,0,0,0,0,0,0,0\n");
    write_probe_csv(folder / "out.csv", points, light);
    const std::vector<std::uint8_t> bytes = read_file(folder / "out.csv");
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), probe_csv(points, light));
}

}  // namespace
}  // namespace skybake::io
