// Names of the files of a bake: written and read through the same functions.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace skybake::io::names {

inline const char* const kManifest = "manifest.json";
inline const char* const kCity = "city.glb";
inline const char* const kObjects = "objects.json";
inline const char* const kLightFolder = "light";
inline const char* const kLayerFolder = "layers";

inline std::string base(std::size_t page) {
    return fmt::format("light/p{}_base.exr", page);
}
inline std::string sky_view(std::size_t page) {
    return fmt::format("light/p{}_svf.png", page);
}
inline std::string lamps(std::size_t page) {
    return fmt::format("light/p{}_lamps.png", page);
}
inline const char* const kLampScales = "light/lamp_scales.bin";
inline std::string light(std::size_t instant, std::size_t page) {
    return fmt::format("light/i{}_p{}.exr", instant, page);
}
inline std::string sky(std::size_t instant, std::size_t page) {
    return fmt::format("light/i{}_p{}_sky.png", instant, page);
}
inline std::string sun(std::size_t instant, std::size_t page) {
    return fmt::format("light/i{}_p{}_sun.png", instant, page);
}
inline std::string indirect(std::size_t instant, std::size_t page) {
    return fmt::format("light/i{}_p{}_indirect.png", instant, page);
}
inline std::string leaks(std::size_t instant, std::size_t page) {
    return fmt::format("light/i{}_p{}_leaks.png", instant, page);
}
inline std::string indirect_scales(std::size_t instant) {
    return fmt::format("light/i{}_indirect_scales.bin", instant);
}
inline std::string scales(std::size_t instant) {
    return fmt::format("light/i{}_scales.bin", instant);
}
inline std::string panorama(std::size_t instant) {
    return fmt::format("light/i{}_sky.bin", instant);
}
/// A study's layer: "png" or "exr".
inline std::string layer(const std::string& id, std::size_t page, const char* extension) {
    return fmt::format("{}/{}_{}.{}", kLayerFolder, id, page, extension);
}
inline std::string air(std::size_t instant) {
    return fmt::format("light/i{}_air.bin", instant);
}

}  // namespace skybake::io::names
