// Objects of one file on their way into the city: the same for every format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/box.h"
#include "base/finding.h"
#include "city/city_model.h"

namespace skybake::io {

enum class UpAxis : std::uint8_t { y, z };

/// Where a mesh lies whose file says nothing of a place: turned to z up, then moved by `origin`, metres.
struct MeshPlacement {
    std::optional<UpAxis> up{};  // without one the custom of its format: z in OBJ, y in glTF
    Vec3d origin{0.0};
};

/// What a raster of heights shows: bare ground, or all that stands on it, too.
enum class RasterContent : std::uint8_t { terrain, surface };

struct RasterOptions {
    RasterContent content = RasterContent::terrain;
    double max_error_m = 0.1;  // of the triangles against every height of the raster, up or down; 0 keeps every height
};

struct FootprintOptions {
    std::string height_field{};  // attribute that holds the height above ground in metres; empty: the known names
    double storey_m = 3.0;       // where only storeys are told
};

struct ReadOptions {
    /// The wanted LoD as "2.2", "1" …; without one the highest that each object offers.
    std::optional<std::string> lod;
    MeshPlacement placement{};
    RasterOptions raster{};
    FootprintOptions footprints{};
};

struct ReadFile {
    std::uint64_t bytes = 0;
    std::uint64_t content_hash = 0;           // FNV-1a of the bytes: tells a changed input, guards against no forger
    std::vector<std::string> above_ground{};  // ids of objects whose heights count from the ground below them
};

/// FNV-1a of bytes that come in pieces.
class ContentHash {
  public:
    void add(std::string_view bytes) {
        for (const char c : bytes) state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    }
    std::uint64_t value() const;

  private:
    std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

struct ReadObject {
    CityObject object;
    std::vector<std::string> children;
    std::vector<std::string> lods;  // that the file offers for it
    bool has_only_flat = false;     // nothing above LoD 0, and no ground
    bool is_appearance_of_templates = false;
};

/// From numbers of materials and textures in a file to those of the city.
struct AppearanceMap {
    std::vector<MaterialId> materials;
    std::vector<TextureId> textures;
};

/// What a file says of itself.
struct FileFacts {
    std::string crs;  // empty when it names none
    std::optional<Box3d> stated_extent;
    Vec3d translate{0.0};  // of its transform; (0, 0, 0) without one
};

class CityAssembly {
  public:
    /// `name` is what findings call the file; city and findings must outlive the assembly.
    CityAssembly(const std::filesystem::path& path, CityModel& city, FindingLog& findings);

    const std::string& name() const { return name_; }

    /// Equal materials and textures become one: city models repeat them for each building.
    AppearanceMap add_appearance(const std::vector<Material>& materials, const std::vector<Texture>& textures);

    /// Takes the object into the city, with its materials and textures renumbered.
    void add(ReadObject read, const AppearanceMap& map);

    /// When all objects are in: families, ids, coordinates that are no place, LoDs, extent, CRS.
    void finish(const FileFacts& facts);

  private:
    std::filesystem::path path_;
    std::string name_;
    CityModel& city_;
    FindingLog& findings_;
    std::size_t first_object_;
    bool is_pool_ready_ = false;
    std::unordered_map<std::string, MaterialId> material_ids_;
    std::unordered_map<std::string, TextureId> texture_ids_;
    std::set<std::string> lods_;
    std::unordered_map<std::string, std::string> child_parent_;
    std::vector<char> has_only_flat_;
};

}  // namespace skybake::io
