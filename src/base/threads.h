// How many threads the parallel loops may use.
#pragma once

#include <tbb/global_control.h>
#include <tbb/info.h>

namespace skybake {

/// While it lives, parallel loops use at most `threads` threads; 0 means as many as there are cores. More than cores
/// are allowed.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads)
        : control_(tbb::global_control::max_allowed_parallelism,
                   threads > 0 ? static_cast<std::size_t>(threads)
                               : static_cast<std::size_t>(tbb::info::default_concurrency())) {}

  private:
    tbb::global_control control_;
};

}  // namespace skybake
