#include "io/manifest/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <vector>

#include "base/check.h"
#include "base/error.h"

namespace skybake::io {

FileHash hash_file(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw InputError(fmt::format("{}: cannot be read for its fingerprint.", path.string()));
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    SKYBAKE_CHECK_EQ(EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr), 1);
    FileHash hash;
    std::vector<char> block(std::size_t{1} << 20);
    while (stream) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        const std::size_t size = static_cast<std::size_t>(stream.gcount());
        SKYBAKE_CHECK_EQ(EVP_DigestUpdate(context.get(), block.data(), size), 1);
        hash.bytes += size;
    }
    if (stream.bad())
        throw InputError(fmt::format("{}: cannot be read to its end for its fingerprint.", path.string()));
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int digest_size = 0;
    SKYBAKE_CHECK_EQ(EVP_DigestFinal_ex(context.get(), digest.data(), &digest_size), 1);
    for (unsigned int i = 0; i < digest_size; ++i) hash.sha256 += fmt::format("{:02x}", digest[i]);
    return hash;
}

}  // namespace skybake::io
