// Points at which light is asked for, and what was found there: the CSV contracts of the verb `probe`
// (docs/formats.md).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace skybake::io {

struct ProbePoint {
    std::string id;
    Vec3d position{0.0};          // map coordinates, metres
    Vec3d normal{0.0, 0.0, 1.0};  // unit
};

/// Light at a point; illuminance in lx.
struct ProbeLight {
    double sun_lx = 0.0;
    double sky_lx = 0.0;
    double indirect_lx = 0.0;
    Rgb total{0.0f};                 // lx per channel, linear Rec. 709
    double sun_visible = 0.0;        // 0…1
    double sky_view_factor = 0.0;    // 0…1
    double lamps_lx = 0.0;           // direct light of lamps
    double indirect_error_lx = 0.0;  // standard error of indirect_lx, where it is an estimate
};

/// Reads `id,x,y,z,nx,ny,nz` below a header line that names these columns first; columns after them are ignored. Fields
/// may be quoted as in RFC 4180. Normals need not be unit; they are made so. Throws InputError, with the line, for a
/// missing or wrong header, too few fields, text in place of a number, a value that is not finite, or a normal without
/// length.
std::vector<ProbePoint> read_points(const std::filesystem::path& path);

/// `id,sun_lx,sky_lx,indirect_lx,total_lx,total_r,total_g,total_b,sun_visible,sky_view_factor,lamps_lx,indirect_error_lx`,
/// a line a point; numbers with the fewest digits that read back as the same float. total_lx is the luminance of
/// `total`. `points` and `light` have the same length.
std::string probe_csv(std::span<const ProbePoint> points, std::span<const ProbeLight> light);

/// The same text as a file, beside and renamed.
void write_probe_csv(const std::filesystem::path& path, std::span<const ProbePoint> points,
                     std::span<const ProbeLight> light);

}  // namespace skybake::io
