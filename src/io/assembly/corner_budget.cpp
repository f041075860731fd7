#include "io/assembly/corner_budget.h"

#include <fmt/format.h>

#include "base/error.h"

namespace skybake::io {

void CornerBudget::fail() const {
    throw InputError(
        fmt::format("{}: repeats its shapes until they have more than {} corners, which is more than is read. Leave "
                    "repeated objects out, or split the file.",
                    name_, most_));
}

}  // namespace skybake::io
