// A saved view of a bake.
#pragma once

#include <string>

#include "base/vec.h"

namespace skybake::io {

/// A place to look from; local metres, z up.
struct BakeView {
    std::string name;
    Vec3f position{0.0f};
    Vec3f target{0.0f};
};

}  // namespace skybake::io
