// Based on: OpenStreetMap, "Simple 3D Buildings", https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings.
#include "io/gdal/read_footprints.h"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "city/extrude.h"
#include "city/finding_codes.h"
#include "io/assembly/file_format.h"
#include "io/gdal/gdal_file.h"

namespace skybake::io {
namespace {

constexpr double kHighestBuilding = 2000.0;  // metres; above it a height is a slip of the pen
/// A roof's height where only its shape is told: 30° on half the width, at most half of the building.
const double kUsualPitch = std::tan(radians_from_degrees(30.0));
constexpr double kMetresPerDegree = 111'320.0;  // along a meridian, to 0.6 %

using Attributes = std::map<std::string, std::string>;  // by name in lower case

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
    return result;
}

/// "key"=>"value","key"=>"value": how GDAL writes OSM's further tags.
void add_other_tags(std::string_view text, Attributes& attributes) {
    while (true) {
        std::array<std::string_view, 2> words;
        for (std::string_view& word : words) {
            const std::size_t begin = text.find('"');
            const std::size_t end = begin == std::string_view::npos ? begin : text.find('"', begin + 1);
            if (end == std::string_view::npos) return;
            word = text.substr(begin + 1, end - begin - 1);
            text.remove_prefix(end + 1);
        }
        attributes.emplace(lower(words[0]), words[1]);
    }
}

Attributes attributes_of(const OGRFeature& feature) {
    Attributes attributes;
    for (int i = 0; i < feature.GetFieldCount(); ++i) {
        if (!feature.IsFieldSetAndNotNull(i)) continue;
        attributes.emplace(lower(feature.GetFieldDefnRef(i)->GetNameRef()), feature.GetFieldAsString(i));
    }
    if (const auto tags = attributes.find("other_tags"); tags != attributes.end())
        add_other_tags(std::string(tags->second), attributes);
    return attributes;
}

/// The number at the beginning of "12.5", "12.5 m".
std::optional<double> number_in(const Attributes& attributes, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        const auto found = attributes.find(name);
        if (found == attributes.end()) continue;
        std::string_view text = found->second;
        text.remove_prefix(std::min(text.find_first_not_of(" +"), text.size()));
        double value = 0.0;
        const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
        const std::string_view unit = text.substr(static_cast<std::size_t>(parsed.ptr - text.data()));
        if (parsed.ec == std::errc() && std::isfinite(value) && (unit.empty() || unit == "m" || unit == " m"))
            return value;
    }
    return std::nullopt;
}

std::string text_in(const Attributes& attributes, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        if (const auto found = attributes.find(name); found != attributes.end() && !found->second.empty())
            return found->second;
    }
    return "";
}

class FootprintReader {
  public:
    FootprintReader(const std::filesystem::path& path, const ReadOptions& options, CityModel& city,
                    FindingLog& findings, Progress& progress)
        : path_(path),
          options_(options.footprints),
          height_field_(lower(options.footprints.height_field)),
          city_(city),
          findings_(findings),
          progress_(progress) {}

    ReadFile read() {
        ReadFile file{checked_file_size(path_), hash_of_file(path_)};
        const QuietErrors quiet;
        const DatasetPtr dataset = open_dataset(path_, GDAL_OF_VECTOR, kVectorDrivers);
        progress_.begin("read " + path_.filename().string(), static_cast<std::uint64_t>(dataset->GetLayerCount()));
        for (int i = 0; i < dataset->GetLayerCount(); ++i) {
            OGRLayer* layer = dataset->GetLayer(i);
            if (layer) read_layer(*layer);
            progress_.advance(1);
        }
        file.above_ground = std::move(above_ground_);
        return file;
    }

  private:
    void read_layer(OGRLayer& layer) {
        // A layer has a system of its own, so it is a file of its own to the city.
        CityAssembly assembly(path_, city_, findings_);
        const NamedSystem system = named_system(layer.GetSpatialRef());
        is_degrees_ = layer.GetSpatialRef() && layer.GetSpatialRef()->IsGeographic();
        CPLErrorReset();
        layer.ResetReading();
        while (const OGRFeatureUniquePtr feature{layer.GetNextFeature()}) {
            if (progress_.stop_requested()) throw Interrupted();
            read_feature(*feature, layer, system, assembly);
        }
        if (CPLGetLastErrorType() >= CE_Failure) {
            throw InputError(fmt::format(
                "{}: is damaged: its features end early ({}). Complete the download, or write it anew with GDAL.",
                path_.string(), CPLGetLastErrorMsg()));
        }
        FileFacts facts;
        facts.crs = system.name;
        assembly.finish(facts);
    }

    void read_feature(const OGRFeature& feature, OGRLayer& layer, const NamedSystem& system, CityAssembly& assembly) {
        const Attributes attributes = attributes_of(feature);
        std::string id = text_in(attributes, {"id", "@id", "osm_id", "osm_way_id", "gml_id", "identificatie"});
        if (id.empty()) id = fmt::format("{} {}", layer.GetName(), feature.GetFID());
        const std::string where = fmt::format("{}: {} '{}'", assembly.name(), layer.GetName(), id);
        const auto tell = [&](std::string_view code, std::string what) {
            findings_.add(make_finding(code, where, std::move(what)));
        };
        const OGRGeometry* shape = feature.GetGeometryRef();
        const auto linear = shape ? std::unique_ptr<OGRGeometry>(shape->getLinearGeometry()) : nullptr;
        const OGRwkbGeometryType kind = linear ? wkbFlatten(linear->getGeometryType()) : wkbUnknown;
        if (kind != wkbPolygon && kind != wkbMultiPolygon) return tell("SB102", "is no polygon; left out.");

        Footprint footprint;
        if (!set_heights(attributes, footprint)) return tell("SB123", "tells neither height nor storeys; left out.");
        ReadObject read;
        CityObject& object = read.object;
        object.id = id;
        object.type = ObjectType::building;
        object.type_name = "Building";
        object.lod = std::string("1");
        object.where = where;
        object.attributes_json = json_of(attributes);
        const bool has_heights = linear->Is3D();
        const auto add = [&](const OGRPolygon& polygon) {
            Footprint part = footprint;
            const double ground = read_rings(polygon, part);
            if (part.rings.empty()) return tell("SB204", "has no outline of three corners; left out.");
            set_roof(attributes, part, tell);
            part.base_m += ground;
            part.eaves_m += ground;
            part.ridge_m += ground;
            extrude(part, object.geometry);
        };
        if (kind == wkbPolygon) {
            add(*linear->toPolygon());
        } else {
            for (const OGRPolygon* polygon : *linear->toMultiPolygon()) add(*polygon);
        }
        if (object.geometry.is_empty()) return;
        for (Vec3d& p : object.geometry.vertices) p = Vec3d(system.place(p.x, p.y), p.z);
        if (!has_heights) above_ground_.push_back(object.id);
        read.lods = {object.lod};
        assembly.add(std::move(read), {});
    }

    /// Base, eaves and ridge above the ground; false when no height is told.
    bool set_heights(const Attributes& attributes, Footprint& footprint) const {
        std::optional<double> height =
            height_field_.empty() ? number_in(attributes, {"height", "building:height", "building_height",
                                                           "measuredheight", "measured_height", "est_height", "hoehe"})
                                  : number_in(attributes, {height_field_.c_str()});
        if (!height && height_field_.empty()) {
            const auto levels = number_in(attributes, {"building:levels", "building_levels", "levels", "num_floors",
                                                       "storeysaboveground", "storeys"});
            const double roof = number_in(attributes, {"roof:levels", "roof_levels"}).value_or(0.0);
            if (levels) height = (*levels + roof) * options_.storey_m;
        }
        if (!height || !(*height > 0.0) || *height > kHighestBuilding) return false;
        const double levels_below = number_in(attributes, {"building:min_level", "min_level"}).value_or(0.0);
        const double base =
            number_in(attributes, {"min_height", "building:min_height"}).value_or(levels_below * options_.storey_m);
        if (!(base >= 0.0) || base >= *height) return false;
        footprint.base_m = base;
        footprint.eaves_m = footprint.ridge_m = *height;
        return true;
    }

    void set_roof(const Attributes& attributes, Footprint& footprint, const auto& tell) const {
        const std::string shape = lower(text_in(attributes, {"roof:shape", "roof_shape"}));
        if (shape.empty() || shape == "flat") return;
        footprint.roof = shape == "gabled"      ? RoofShape::gabled
                         : shape == "hipped"    ? RoofShape::hipped
                         : shape == "pyramidal" ? RoofShape::pyramidal
                                                : RoofShape::flat;
        if (footprint.roof == RoofShape::flat || !fits(footprint.roof, footprint)) {
            footprint.roof = RoofShape::flat;
            return tell("SB124", fmt::format("roof '{}' on {} corners is taken as flat.", shape.substr(0, 40),
                                             footprint.rings[0].size()));
        }
        footprint.is_ridge_across = lower(text_in(attributes, {"roof:orientation"})) == "across";
        const double height = footprint.ridge_m - footprint.base_m;
        std::optional<double> roof = number_in(attributes, {"roof:height", "roof_height"});
        if (!roof) {
            if (const auto levels = number_in(attributes, {"roof:levels", "roof_levels"}); levels && *levels > 0.0)
                roof = *levels * options_.storey_m;
        }
        if (!roof) {
            double shortest = INFINITY;
            const std::vector<Vec2d>& ring = footprint.rings[0];
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Vec2d side = (ring[(i + 1) % ring.size()] - ring[i]) * footprint.metres_per_unit;
                shortest = std::min(shortest, glm::length(side));
            }
            roof = std::min(0.5 * shortest * kUsualPitch, 0.5 * height);
        }
        footprint.eaves_m = footprint.ridge_m - std::clamp(*roof, 0.0, height);
    }

    /// Sets the rings; returns their lowest height, 0 without heights.
    double read_rings(const OGRPolygon& polygon, Footprint& footprint) const {
        double lowest = INFINITY;
        for (const OGRLinearRing* ring : polygon) {
            std::vector<Vec2d> corners;
            for (int i = 0; i < ring->getNumPoints(); ++i) {
                corners.emplace_back(ring->getX(i), ring->getY(i));
                if (polygon.Is3D()) lowest = std::min(lowest, ring->getZ(i));
            }
            while (corners.size() > 1 && corners.back() == corners.front()) corners.pop_back();
            if (corners.size() >= 3) {
                footprint.rings.push_back(std::move(corners));
            } else if (footprint.rings.empty()) {
                return 0.0;
            }
        }
        if (is_degrees_ && !footprint.rings.empty()) {
            const double latitude = radians_from_degrees(footprint.rings[0][0].y);
            footprint.metres_per_unit = Vec2d(std::cos(latitude), 1.0) * kMetresPerDegree;
        }
        return std::isfinite(lowest) ? lowest : 0.0;
    }

    static std::string json_of(const Attributes& attributes) {
        return nlohmann::json(attributes).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    }

    std::filesystem::path path_;
    FootprintOptions options_;
    std::string height_field_;
    CityModel& city_;
    FindingLog& findings_;
    Progress& progress_;
    bool is_degrees_ = false;
    std::vector<std::string> above_ground_;
};

}  // namespace

ReadFile read_footprints(const std::filesystem::path& path, const ReadOptions& options, CityModel& city,
                         FindingLog& findings, Progress& progress) {
    return FootprintReader(path, options, city, findings, progress).read();
}

}  // namespace skybake::io
