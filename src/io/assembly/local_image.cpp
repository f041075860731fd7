#include "io/assembly/local_image.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/rgb.h"
#include "city/finding_codes.h"

namespace skybake::io {

std::optional<std::filesystem::path> path_below(const std::filesystem::path& folder, std::string_view uri) {
    std::string relative(uri);
    std::replace(relative.begin(), relative.end(), '\\', '/');
    const std::filesystem::path path = std::filesystem::path(relative).lexically_normal();
    if (path.is_absolute() || (!path.empty() && *path.begin() == "..")) return std::nullopt;
    // What is there may be a link that leads out of the folder.
    std::error_code error;
    const std::filesystem::path root = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, error);
    const std::filesystem::path target = std::filesystem::weakly_canonical(folder / path, error);
    if (error || std::mismatch(root.begin(), root.end(), target.begin(), target.end()).first != root.end())
        return std::nullopt;
    return folder / path;
}

void find_image(Texture& texture, const std::filesystem::path& folder, const std::string& where, FindingLog& findings) {
    texture.is_missing = true;
    if (texture.uri.find("://") != std::string::npos) {
        findings.add(
            make_finding("SB401", where, fmt::format("image '{}' is remote and is not fetched.", texture.uri)));
        return;
    }
    const std::optional<std::filesystem::path> path = path_below(folder, texture.uri);
    if (!path) {
        findings.add(make_finding(
            "SB402", where, fmt::format("image '{}' lies outside the folder of the city file; refused.", texture.uri)));
        return;
    }
    std::error_code error;
    if (texture.uri.empty() || !std::filesystem::is_regular_file(*path, error)) {
        findings.add(make_finding("SB401", where, fmt::format("image '{}' is missing.", texture.uri)));
        return;
    }
    texture.path = path->string();
    texture.is_missing = false;
}

Rgb linear_from_display(double red, double green, double blue) {
    const auto channel = [](double v) { return linear_from_srgb(static_cast<float>(std::clamp(v, 0.0, 1.0))); };
    return {channel(red), channel(green), channel(blue)};
}

}  // namespace skybake::io
