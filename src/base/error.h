// Input that is unusable as a whole: no such file, broken JSON, a bad option. Thrown by the readers and the command
// line only; what is wrong with a part of the input is a Finding (base/finding.h).
#pragma once

#include <stdexcept>
#include <string>

namespace skybake {

/// The message names file, place, fault and remedy; the program prints it and exits with 2.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The user asked to stop (Ctrl-C); the program exits with 130.
class Interrupted : public std::runtime_error {
  public:
    Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace skybake
