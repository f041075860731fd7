// Numbers in the options of the light.
#pragma once

#include <optional>
#include <string_view>

namespace skybake {

/// The whole text as a finite number, a sign in front allowed; nothing for anything else.
std::optional<double> number_of(std::string_view text);

}  // namespace skybake
