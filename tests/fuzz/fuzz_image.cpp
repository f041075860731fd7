// A picture, whatever its bytes: it is decoded, or ends in an InputError.
#include <cstdint>

#include "base/error.h"
#include "io/image/image.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        skybake::io::decode_image({data, size}, "input", 1u << 22);
    } catch (const skybake::InputError&) {
    }
    return 0;
}
