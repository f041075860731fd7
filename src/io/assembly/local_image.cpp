#include "io/assembly/local_image.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/rgb.h"
#include "city/finding_codes.h"

namespace skybake::io {

void find_image(Texture& texture, const std::filesystem::path& folder, const std::string& where, FindingLog& findings) {
    texture.is_missing = true;
    std::string relative = texture.uri;
    std::replace(relative.begin(), relative.end(), '\\', '/');
    if (relative.find("://") != std::string::npos) {
        findings.add(
            make_finding("SB401", where, fmt::format("image '{}' is remote and is not fetched.", texture.uri)));
        return;
    }
    const std::filesystem::path path = std::filesystem::path(relative).lexically_normal();
    if (path.is_absolute() || (!path.empty() && *path.begin() == "..")) {
        findings.add(make_finding(
            "SB402", where, fmt::format("image '{}' lies outside the folder of the city file; refused.", texture.uri)));
        return;
    }
    std::error_code error;
    if (relative.empty() || !std::filesystem::is_regular_file(folder / path, error)) {
        findings.add(make_finding("SB401", where, fmt::format("image '{}' is missing.", texture.uri)));
        return;
    }
    texture.path = (folder / path).string();
    texture.is_missing = false;
}

Rgb linear_from_display(double red, double green, double blue) {
    const auto channel = [](double v) { return linear_from_srgb(static_cast<float>(std::clamp(v, 0.0, 1.0))); };
    return {channel(red), channel(green), channel(blue)};
}

}  // namespace skybake::io
