#include "io/lamps/read_lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "base/error.h"
#include "io/file/replace_file.h"
#include "io/lamps/lamp_json.h"

namespace skybake::io {
namespace {

std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;) word = word << 8 | bytes[at + i];
    return word;
}

/// The JSON of a binary glTF: its first chunk, behind a header of 12 bytes and the chunk's of 8.
std::span<const std::uint8_t> json_chunk(std::span<const std::uint8_t> bytes, const std::filesystem::path& path) {
    constexpr std::uint32_t kJson = 0x4e4f534a;
    if (bytes.size() < 20 || word_at(bytes, 4) != 2 || word_at(bytes, 16) != kJson ||
        word_at(bytes, 12) > bytes.size() - 20)
        throw InputError(fmt::format("{}: is no whole binary glTF 2.0. Export it again.", path.string()));
    return bytes.subspan(20, word_at(bytes, 12));
}

}  // namespace

LampFile read_lamps(const std::filesystem::path& path, const Vec3d& origin, const std::optional<Vec3d>& gltf_origin,
                    FindingLog& findings) {
    const std::vector<std::uint8_t> bytes = read_file(path);
    constexpr std::array<std::uint8_t, 4> kMagic{'g', 'l', 'T', 'F'};
    const bool is_binary = bytes.size() >= 4 && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
    const std::span<const std::uint8_t> text = is_binary ? json_chunk(bytes, path) : std::span(bytes);
    nlohmann::json file;
    try {
        file = nlohmann::json::parse(text.begin(), text.end());
    } catch (const nlohmann::json::parse_error& error) {
        throw InputError(fmt::format("{}: is no JSON: {}", path.string(), error.what()));
    }
    const bool is_gltf = is_binary || (file.is_object() && file.contains("asset") && !file.contains("lamps"));
    return is_gltf ? lamps_of_gltf(file, path, origin, gltf_origin, findings) : lamps_of_json(file, path, origin);
}

}  // namespace skybake::io
