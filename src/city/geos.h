// GEOS behind values that free themselves. Private to the folder; the only header that shows GEOS.
#pragma once

#define GEOS_USE_ONLY_R_API
#include <geos_c.h>

#include <memory>
#include <span>

#include "base/vec.h"

namespace skybake::geos {

/// A GEOS context: not thread-safe itself, so each thread has its own (`context()`). Errors are silent; functions
/// return null.
class Context {
  public:
    Context() : handle_(GEOS_init_r()) {}
    ~Context() { GEOS_finish_r(handle_); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    GEOSContextHandle_t get() const { return handle_; }

  private:
    GEOSContextHandle_t handle_;
};

/// This thread's context.
inline GEOSContextHandle_t context() {
    thread_local const Context own;
    return own.get();
}

struct GeometryDeleter {
    void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(context(), g); }
};
using GeometryPtr = std::unique_ptr<GEOSGeometry, GeometryDeleter>;

/// A closed ring from points that do not repeat the first; null when there are fewer than three.
inline GeometryPtr make_ring(std::span<const Vec2d> points) {
    if (points.size() < 3) return nullptr;
    GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context(), static_cast<unsigned>(points.size() + 1), 2);
    for (std::size_t i = 0; i <= points.size(); ++i) {
        const Vec2d& p = points[i % points.size()];
        GEOSCoordSeq_setXY_r(context(), sequence, static_cast<unsigned>(i), p.x, p.y);
    }
    return GeometryPtr(GEOSGeom_createLinearRing_r(context(), sequence));
}

}  // namespace skybake::geos
