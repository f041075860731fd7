// Levels of detail: what a geometry states, and which of those offered an object shows. One rule for all formats.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace skybake::io {

/// A level of detail: its text as "2.2" and its value.
struct Lod {
    std::string text;
    double value = 0.0;
};

/// The LoD that `text` states, from 0 on; none when it is no number.
std::optional<Lod> parse_lod(std::string_view text);

/// Which LoD to show: the highest, or the nearest to the asked one.
struct LodChoice {
    std::optional<Lod> asked;
};

/// The choice that the option --lod makes. Throws InputError when it is no LoD below 10.
LodChoice lod_choice(const std::optional<std::string>& option);

/// The LoD to take of those offered (not empty): the highest; or the asked one, for a whole number also its refinements
/// (2 takes 2.2), else the nearest below, else the nearest above.
Lod choose_lod(std::span<const Lod> offered, const LodChoice& choice);

/// True when `taken` is what was asked for.
bool fits(const Lod& taken, const Lod& asked);

}  // namespace skybake::io
