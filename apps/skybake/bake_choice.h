// Which light of a bake is meant: options that stills and exports share.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/manifest/read_picture.h"
#include "view_link.h"

namespace skybake::cli {

/// Throws InputError: `option` knows no `given`, and which of `known` comes nearest.
[[noreturn]] void unknown_word(const std::string& option, const std::string& given,
                               const std::vector<std::string>& known);

/// The instant that --at means: its number, its label or the beginning of one; else the link's; else the first. Throws
/// InputError when there is none.
std::size_t instant_of(const io::StoredBake& bake, const std::string& at, const std::optional<ViewLink>& link);

/// --parts, as "sun,sky=0.5"; empty for all parts as they are. Throws InputError for parts that are not `known`.
io::PartFactors parts_of(const std::string& text, const std::vector<std::string>& known);

/// All parts as the link scales them or switches them off; empty for all parts as they are.
io::PartFactors parts_of(const ViewLink& link, const std::vector<std::string>& known);

}  // namespace skybake::cli
