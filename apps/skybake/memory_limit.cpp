#include "memory_limit.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>

namespace skybake::cli {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif
#else
constexpr bool kIsSanitized = false;
#endif

/// Bytes that can be had without taking them from others; 0 where the system does not tell.
std::uint64_t free_bytes() {
    std::ifstream in("/proc/meminfo");
    std::uint64_t sum = 0;
    for (std::string line; std::getline(in, line);) {
        for (const std::string key : {"MemAvailable:", "SwapFree:"}) {
            if (line.rfind(key, 0) == 0) sum += std::stoull(line.substr(key.size())) * 1024;
        }
    }
    // A container may have less: version 2 of control groups, then version 1.
    for (const char* path : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        std::uint64_t limit = 0;
        if (std::ifstream(path) >> limit && limit > 0) sum = std::min(sum, limit);
    }
    return sum;
}

}  // namespace

void limit_memory() {
    const std::uint64_t bytes = kIsSanitized ? 0 : free_bytes();
    rlimit limit{};
    if (bytes == 0 || getrlimit(RLIMIT_DATA, &limit) != 0) return;
    if (limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur <= bytes) return;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_DATA, &limit);
}

void lift_memory_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_DATA, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace skybake::cli
