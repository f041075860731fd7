#pragma once
namespace skybake {
struct PreethamSky {};
}
