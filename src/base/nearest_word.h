// "Did you mean …?": the known word that is nearest to what the user typed.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace skybake {

/// The entry of `known` with the smallest Levenshtein distance to `typed`, the first of equals; empty when `known` is.
std::string nearest_word(std::string_view typed, std::span<const std::string> known);

}  // namespace skybake
