// Which format a file is, by its first bytes: to choose the reader, or to refuse it by name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace skybake::io {

/// The first bytes of a file (at most 2048). Throws InputError when it cannot be opened or is empty.
std::string head_of(const std::filesystem::path& path);

/// What the first bytes of a file look like: "CityGML", "Wavefront OBJ", "3D Tiles (b3dm)" …; empty when it may be
/// CityJSON, "a file of unknown format" for anything else.
std::string format_of(std::string_view head);

/// Fails with an InputError when there is no such file, or it is none; else its size in bytes.
std::uintmax_t checked_file_size(const std::filesystem::path& path);

/// FNV-1a of all its bytes (ContentHash), for readers that leave opening the file to a library. Throws InputError when
/// it cannot be read.
std::uint64_t hash_of_file(const std::filesystem::path& path);

}  // namespace skybake::io
