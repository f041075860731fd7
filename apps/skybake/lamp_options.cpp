#include "lamp_options.h"

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "sky/text_numbers.h"

namespace skybake::cli {

void add_lamp_options(CLI::App* verb, LampOptions& options) {
    constexpr const char* kGroup = "Lamps";
    verb->add_option("--lamps", options.file, "lamps: JSON (docs/formats.md), or a glTF with punctual lights")
        ->group(kGroup)
        ->type_name("FILE");
    verb->add_option("--lamps-origin", options.origin,
                     "map coordinates of the glTF's origin (default: what the glTF of a bake states, else 0,0,0)")
        ->group(kGroup)
        ->type_name("X,Y,Z");
}

std::optional<Vec3d> origin_of(const LampOptions& options) {
    if (options.origin.empty()) return std::nullopt;
    std::string_view rest = options.origin;
    Vec3d origin(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t end = axis < 2 ? rest.find(',') : rest.size();
        const auto value = end == std::string_view::npos ? std::nullopt : number_of(rest.substr(0, end));
        if (!value) throw InputError("--lamps-origin: three numbers are needed, X,Y,Z in map coordinates.");
        origin[axis] = *value;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return origin;
}

}  // namespace skybake::cli
