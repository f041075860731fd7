#include "io/photometry/read_profile.h"

#include "io/file/replace_file.h"
#include "io/photometry/profile_text.h"

namespace skybake::io {

LightProfile read_profile(const std::filesystem::path& path) {
    constexpr std::uint64_t kMostBytes = 1u << 24;
    const std::vector<std::uint8_t> bytes = read_file(path, kMostBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    ProfileText lines(path.string(), text);
    return text.find("TILT=") != std::string_view::npos ? parse_ies(lines) : parse_eulumdat(lines);
}

}  // namespace skybake::io
