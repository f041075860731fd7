#include "io/assembly/city_assembly.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/hash_rng.h"
#include "city/families.h"
#include "city/georeference.h"
#include "city/repair.h"

namespace skybake::io {
namespace {

std::string key_of(const Material& m) {
    return fmt::format("{} {} {} {}", m.albedo.x, m.albedo.y, m.albedo.z, m.transparency);
}

std::string key_of(const Texture& t) {
    return fmt::format("{}|{}|{}|{} {} {}", t.path, t.path.empty() ? t.uri : "", static_cast<int>(t.wrap),
                       t.border_color.x, t.border_color.y, t.border_color.z);
}

}  // namespace

std::uint64_t ContentHash::value() const {
    return mix64(state_);
}

CityAssembly::CityAssembly(const std::filesystem::path& path, CityModel& city, FindingLog& findings)
    : path_(path),
      name_(path.filename().string()),
      city_(city),
      findings_(findings),
      first_object_(city.objects.size()) {}

AppearanceMap CityAssembly::add_appearance(const std::vector<Material>& materials,
                                           const std::vector<Texture>& textures) {
    if (!is_pool_ready_) {
        for (std::size_t i = 0; i < city_.materials.size(); ++i)
            material_ids_.emplace(key_of(city_.materials[i]), MaterialId(i));
        for (std::size_t i = 0; i < city_.textures.size(); ++i)
            texture_ids_.emplace(key_of(city_.textures[i]), TextureId(i));
        is_pool_ready_ = true;
    }
    AppearanceMap map;
    for (const Material& material : materials) {
        const auto [entry, is_new] = material_ids_.emplace(key_of(material), MaterialId(city_.materials.size()));
        if (is_new) city_.materials.push_back(material);
        map.materials.push_back(entry->second);
    }
    for (const Texture& texture : textures) {
        const auto [entry, is_new] = texture_ids_.emplace(key_of(texture), TextureId(city_.textures.size()));
        if (is_new) city_.textures.push_back(texture);
        map.textures.push_back(entry->second);
    }
    return map;
}

void CityAssembly::add(ReadObject read, const AppearanceMap& map) {
    for (Surface& surface : read.object.geometry.surfaces) {
        if (surface.material) surface.material = map.materials[surface.material->index()];
        if (surface.texture) surface.texture = map.textures[surface.texture->index()];
    }
    for (std::string& lod : read.lods) lods_.insert(std::move(lod));
    const bool is_group = read.object.type_name == "CityObjectGroup";  // a list of objects, no body of parts
    for (std::string& child : read.children) {
        if (!is_group) child_parent_.emplace(std::move(child), read.object.id);
    }
    has_only_flat_.push_back(read.has_only_flat);
    city_.objects.push_back(std::move(read.object));
}

void CityAssembly::finish(const FileFacts& facts) {
    for (std::size_t i = first_object_; i < city_.objects.size(); ++i) {
        CityObject& object = city_.objects[i];
        if (!object.parent_id.empty()) continue;
        const auto found = child_parent_.find(object.id);
        if (found != child_parent_.end() && found->second != object.id) object.parent_id = found->second;
    }
    resolve_families(city_, first_object_, has_only_flat_, findings_);
    make_ids_unique(city_, first_object_, findings_);
    drop_bad_coordinates(city_, first_object_, findings_);
    repair_offset(city_, first_object_, facts.translate, facts.stated_extent, name_, findings_);

    for (const std::string& lod : city_.lods) lods_.insert(lod);
    city_.lods.assign(lods_.begin(), lods_.end());
    std::stable_sort(city_.lods.begin(), city_.lods.end(), [](const std::string& a, const std::string& b) {
        return std::strtod(a.c_str(), nullptr) < std::strtod(b.c_str(), nullptr);
    });
    if (!facts.crs.empty() && !city_.crs.empty()) bring_into_system(city_, first_object_, facts.crs, name_, findings_);
    if (city_.crs.empty()) city_.crs = facts.crs;
    if (facts.stated_extent) {
        if (!city_.stated_extent) city_.stated_extent = Box3d();
        city_.stated_extent->extend(*facts.stated_extent);
    }
    city_.files.push_back(path_.string());
}

}  // namespace skybake::io
