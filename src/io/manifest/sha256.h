// Fingerprints of the inputs for the manifest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace skybake::io {

struct FileHash {
    std::uint64_t bytes = 0;
    std::string sha256;  // 64 lower-case hexadecimal digits
};

/// Reads the file in blocks. Throws InputError when it cannot be read.
FileHash hash_file(const std::filesystem::path& path);

}  // namespace skybake::io
