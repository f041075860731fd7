// PROJ behind values that free themselves. Private to the folder; the only header that shows PROJ.
#pragma once

#include <proj.h>

#include <memory>
#include <string>
#include <string_view>

#include "base/vec.h"

namespace skybake::proj {

struct ContextDeleter {
    void operator()(PJ_CONTEXT* c) const { proj_context_destroy(c); }
};
struct PjDeleter {
    void operator()(PJ* p) const { proj_destroy(p); }
};
using ContextPtr = std::unique_ptr<PJ_CONTEXT, ContextDeleter>;
using PjPtr = std::unique_ptr<PJ, PjDeleter>;

/// A silent context that asks no network. Not thread-safe: each thread has its own.
ContextPtr make_context();

/// "EPSG:7415" or "EPSG:25832+5783" out of the names that city files use: codes, OGC URLs, URNs, the German surveys'
/// names; empty when no EPSG code is in it.
std::string code_of(std::string_view name);

/// The coordinate reference system of that name; null when PROJ knows none.
PjPtr crs_of(PJ_CONTEXT* context, const std::string& name);

/// The two-dimensional or geographic system that x and y belong to, out of compound and bound ones.
PjPtr horizontal_of(PJ_CONTEXT* context, const PJ* crs);

bool is_geographic(PJ_TYPE type);

/// True when the first axis is the one to the north.
bool is_north_first(PJ_CONTEXT* context, const PJ* crs);

/// From one system to another, x east (longitude), y north (latitude), degrees; null when PROJ knows no way.
PjPtr transformation(PJ_CONTEXT* context, const PJ* from, const PJ* to);

Vec2d apply(PJ* transform, PJ_DIRECTION direction, const Vec2d& p);

}  // namespace skybake::proj
