// How a long computation reports and how it is stopped: supplied by the caller, so it is an interface.
#pragma once

#include <cstdint>
#include <string_view>

namespace skybake {

class Progress {
  public:
    virtual ~Progress() = default;
    /// A stage begins; `total` counts its steps. Called from one thread.
    virtual void begin(std::string_view stage, std::uint64_t total) = 0;
    /// `steps` more are done. Called from any thread.
    virtual void advance(std::uint64_t steps) = 0;
    /// True when the user wants to stop; the computation then throws Interrupted. Called from any thread.
    virtual bool stop_requested() const = 0;
};

/// Says nothing, never stops.
class SilentProgress final : public Progress {
  public:
    void begin(std::string_view, std::uint64_t) override {}
    void advance(std::uint64_t) override {}
    bool stop_requested() const override { return false; }
};

}  // namespace skybake
