// The message of what is refused.
#pragma once

#include <string>

#include "base/error.h"

namespace skybake {

/// What the InputError that `f()` ends in says; "no error" when it ends well.
template <typename F>
std::string error_of(F&& f) {
    try {
        f();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace skybake
