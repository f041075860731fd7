// Our own broken contracts: print both sides and stop with exit code 3. Bad input is never checked like this
// (base/error.h).
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

namespace skybake {

[[noreturn]] inline void fail_check(const char* file, int line, const char* expression, const std::string& sides) {
    fmt::print(
        stderr,
        "skybake: internal error at {}:{}: {} {}\nThis is a bug of skybake; please report it with the command line.\n",
        file, line, expression, sides);
    std::_Exit(3);
}

}  // namespace skybake

#define SKYBAKE_CHECK(condition) \
    ((condition) ? void(0) : ::skybake::fail_check(__FILE__, __LINE__, #condition, "is false"))
#define SKYBAKE_CHECK_OP_(a, op, b) \
    (((a)op(b)) ? void(0)           \
                : ::skybake::fail_check(__FILE__, __LINE__, #a " " #op " " #b, fmt::format("with {} and {}", a, b)))
#define SKYBAKE_CHECK_EQ(a, b) SKYBAKE_CHECK_OP_(a, ==, b)
#define SKYBAKE_CHECK_LT(a, b) SKYBAKE_CHECK_OP_(a, <, b)
#define SKYBAKE_CHECK_LE(a, b) SKYBAKE_CHECK_OP_(a, <=, b)

#ifdef SKYBAKE_DEBUG_CHECKS
#define SKYBAKE_DCHECK(condition) SKYBAKE_CHECK(condition)
#define SKYBAKE_DCHECK_LT(a, b) SKYBAKE_CHECK_LT(a, b)
#else
#define SKYBAKE_DCHECK(condition) void(0)
#define SKYBAKE_DCHECK_LT(a, b) void(0)
#endif
