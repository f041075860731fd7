#include "api/load_sky_image.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "io/exr/exr.h"
#include "io/image/radiance_hdr.h"
#include "sky/sky_level.h"

namespace skybake {

namespace {

/// Radiance's own luminous efficacy of white light, lm W⁻¹.
constexpr double kRadianceEfficacy = 179.0;

std::string lower_case_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

}  // namespace

void load_sky_image(SkySettings& sky) {
    auto* settings = std::get_if<ImageSettings>(&sky);
    if (!settings || settings->image) return;
    const std::filesystem::path path = settings->file;
    const std::string extension = lower_case_extension(path);
    const bool is_exr = extension == ".exr";
    if (!is_exr && extension != ".hdr" && extension != ".pic") {
        throw InputError(fmt::format(
            "{}: a sky's picture is an OpenEXR (.exr) or a Radiance picture (.hdr, .pic): eight bits a channel cannot "
            "hold a sky. Convert it.",
            settings->file));
    }
    if (!std::filesystem::is_regular_file(path))
        throw InputError(fmt::format("{}: there is no such file. --sky image:FILE names a picture.", settings->file));
    io::PictureRgb picture = is_exr ? io::read_exr_rgb(path) : io::read_radiance_hdr(path);
    if (picture.width != 2 * picture.height) {
        throw InputError(fmt::format(
            "{}: {} x {} pixels are not twice as wide as high. A sky's picture is equirectangular and shows the whole "
            "sphere, zenith on top, true north at the left edge, clockwise; convert other projections.",
            settings->file, picture.width, picture.height));
    }

    FindingLog findings;
    std::size_t impossible = 0;
    for (Rgb& pixel : picture.pixels) {
        bool is_possible = true;
        for (int c = 0; c < 3; ++c) {
            if (std::isfinite(pixel[c]) && pixel[c] >= 0.0f) continue;
            pixel[c] = 0.0f;
            is_possible = false;
        }
        if (!is_possible) ++impossible;
    }
    if (impossible > 0) {
        findings.add({"SB607", Severity::warning, settings->file,
                      fmt::format("{} of {} pixels have a channel that is negative or not finite; it is taken as 0.",
                                  impossible, picture.pixels.size()),
                      "Repair the picture: every channel is finite and not negative."});
    }
    SkyImage image{picture.width, picture.height, std::move(picture.pixels)};
    const double scale = settings->scale.value_or(is_exr ? 1.0 : kRadianceEfficacy);
    if (scale != 1.0) image = scaled(std::move(image), scale);
    settings->image = prepared_image(*settings, std::move(image), findings);
    settings->findings = findings.list();
}

}  // namespace skybake
