// Materials and textures of a CityGML file, and what they are put on.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/finding.h"
#include "city/city_model.h"
#include "io/xml/xml_tree.h"

namespace skybake::io {

/// Texture coordinates of a ring.
struct RingTexture {
    TextureId texture;
    std::uint64_t uv_begin = 0;
    std::uint32_t uv_count = 0;
    bool is_front = true;
};

/// A texture that lies on its surfaces by a formula: (u, v, w) = m (x, y, z, 1), divided by w. Rows of m follow each
/// other.
struct ProjectedTexture {
    TextureId texture;
    std::array<double, 12> m{};
};

/// What a surface, or all below it, wears.
struct SurfaceWear {
    std::optional<MaterialId> material;
    std::optional<std::uint32_t> projected;  // in GmlAppearance::projected
    bool is_material_front = true;
    bool is_texture_front = true;
};

/// Filled once, then read from many threads. Of several themes the first one with materials and the first one with
/// textures count; of front and back the front, and the back where there is no other. Ids are kept as hashes of 64
/// bits.
class GmlAppearance {
  public:
    GmlAppearance(std::filesystem::path folder, std::string file)
        : folder_(std::move(folder)), file_(std::move(file)) {}

    /// Takes a ParameterizedTexture, GeoreferencedTexture or X3DMaterial of the theme; other elements are left.
    void add(XmlElement data, const std::string& theme, FindingLog& findings);
    /// Tells of what was left out for its theme.
    void finish(FindingLog& findings) const;

    const RingTexture* ring(std::string_view id) const;
    const SurfaceWear* surface(std::string_view id) const;
    std::span<const Vec2f> uvs(const RingTexture& ring) const {
        return std::span(uvs_).subspan(ring.uv_begin, ring.uv_count);
    }
    const ProjectedTexture& projected(std::uint32_t number) const { return projected_[number]; }

    std::vector<Material> materials;
    std::vector<Texture> textures;

  private:
    struct Themes {
        std::vector<std::string> names;
        /// True when the theme is the one that counts: the first that asks.
        bool admits(const std::string& theme);
    };
    void add_material(XmlElement data, FindingLog& findings);
    void add_parameterized(XmlElement data, FindingLog& findings);
    void add_georeferenced(XmlElement data, FindingLog& findings);
    Texture read_texture(XmlElement data, FindingLog& findings) const;
    void put_projected(std::string_view target, std::uint32_t number, bool is_front);
    void add_coordinates(XmlElement list, TextureId texture, bool is_front, FindingLog& findings);
    std::string place(XmlElement e) const;

    std::filesystem::path folder_;
    std::string file_;
    Themes material_themes_;
    Themes texture_themes_;
    std::vector<Vec2f> uvs_;
    std::vector<ProjectedTexture> projected_;
    std::unordered_map<std::uint64_t, RingTexture> rings_;
    std::unordered_map<std::uint64_t, SurfaceWear> surfaces_;
};

/// The id that a reference of this file names: "#id" without its mark; empty when it names another file.
std::string_view local_id(std::string_view reference);

}  // namespace skybake::io
