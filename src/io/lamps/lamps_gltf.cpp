// Based on: Khronos Group, "KHR_lights_punctual", glTF 2.0 extension: candela for point and spot lights, along -z of
// the node.
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include "base/error.h"
#include "city/finding_codes.h"
#include "io/lamps/lamp_json.h"

namespace skybake::io {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostNodes = 10'000'000;

class GltfLights {
  public:
    GltfLights(const Json& gltf, std::string name, FindingLog& findings)
        : gltf_(gltf), name_(std::move(name)), findings_(findings) {}

    LampFile read(const Vec3d& origin, const std::optional<Vec3d>& gltf_origin) {
        const Json& scene = scene_of_file();
        offset_ = gltf_origin ? *gltf_origin : stated_origin(scene);
        offset_ -= origin;
        lights_ = &member(member(member(gltf_, "extensions"), "KHR_lights_punctual"), "lights");
        if (!lights_->is_array())
            throw InputError(
                fmt::format("{}: has no lights (KHR_lights_punctual). Export it with its punctual lights.", name_));
        struct Visit {
            std::size_t node;
            glm::dmat4 frame;
        };
        std::vector<Visit> open;
        const auto push_children = [&](const Json& parent, const char* key, const glm::dmat4& frame) {
            const Json& list = member(parent, key);
            for (std::size_t i = list.size(); list.is_array() && i-- > 0;)
                open.push_back({index(list[i], nodes().size(), "node"), frame});
        };
        push_children(scene, "nodes", glm::dmat4(1.0));
        std::vector<bool> is_seen(nodes().size(), false);
        while (!open.empty()) {
            const Visit visit = open.back();
            open.pop_back();
            if (is_seen[visit.node])
                throw InputError(fmt::format("{}: node {} has two parents. Export it again.", name_, visit.node));
            is_seen[visit.node] = true;
            const Json& node = nodes()[visit.node];
            const glm::dmat4 frame = visit.frame * local_frame(node, visit.node);
            const Json& light = member(member(member(node, "extensions"), "KHR_lights_punctual"), "light");
            if (!light.is_null()) add(index(light, lights_->size(), "light"), visit.node, frame);
            push_children(node, "children", frame);
        }
        return std::move(out_);
    }

  private:
    static const Json& member(const Json& object, const char* key) {
        static const Json none;
        if (!object.is_object()) return none;
        const auto found = object.find(key);
        return found == object.end() ? none : *found;
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}. Export it again.", name_, what));
    }

    const Json& nodes() const {
        const Json& list = member(gltf_, "nodes");
        if (!list.is_array() || list.size() > kMostNodes) fail("has no list of nodes");
        return list;
    }

    std::size_t index(const Json& value, std::size_t count, const char* of) const {
        if (!value.is_number_unsigned() || value.get<std::size_t>() >= count)
            fail(fmt::format("names the {} {}, and has {}", of, value.dump(), count));
        return value.get<std::size_t>();
    }

    const Json& scene_of_file() const {
        const Json& scenes = member(gltf_, "scenes");
        if (!scenes.is_array() || scenes.empty()) fail("has no scene");
        const Json& chosen = member(gltf_, "scene");
        return scenes[chosen.is_null() ? 0 : index(chosen, scenes.size(), "scene")];
    }

    /// As skybake's own city.glb states it.
    Vec3d stated_origin(const Json& scene) const {
        const Json& value = member(member(scene, "extras"), "origin");
        if (value.is_null()) return Vec3d(0.0);
        const std::vector<double> v = numbers(value, 3, "the scene's origin");
        return {v[0], v[1], v[2]};
    }

    std::vector<double> numbers(const Json& value, std::size_t count, const std::string& of) const {
        std::vector<double> list;
        for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
            if (value[i].is_number()) list.push_back(value[i].get<double>());
        }
        if (list.size() != count || value.size() != count) fail(fmt::format("{} is not {} numbers", of, count));
        return list;
    }

    glm::dmat4 local_frame(const Json& node, std::size_t n) const {
        if (const Json& matrix = member(node, "matrix"); !matrix.is_null()) {
            const std::vector<double> m = numbers(matrix, 16, fmt::format("the matrix of node {}", n));
            glm::dmat4 frame;
            for (int i = 0; i < 16; ++i) frame[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
            return frame;
        }
        glm::dmat4 frame(1.0);
        if (const Json& value = member(node, "rotation"); !value.is_null()) {
            const std::vector<double> q = numbers(value, 4, fmt::format("the rotation of node {}", n));
            const glm::dquat turn(q[3], q[0], q[1], q[2]);
            if (!(glm::length(turn) > 0.0)) fail(fmt::format("the rotation of node {} is 0", n));
            frame = glm::mat4_cast(glm::normalize(turn));
        }
        if (const Json& value = member(node, "scale"); !value.is_null()) {
            const std::vector<double> s = numbers(value, 3, fmt::format("the scale of node {}", n));
            for (int axis = 0; axis < 3; ++axis) frame[axis] *= s[static_cast<std::size_t>(axis)];
        }
        if (const Json& value = member(node, "translation"); !value.is_null()) {
            const std::vector<double> t = numbers(value, 3, fmt::format("the translation of node {}", n));
            frame[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
        }
        return frame;
    }

    double number(const Json& object, const char* key, double otherwise, double lowest, double highest) const {
        const Json& value = member(object, key);
        if (value.is_null()) return otherwise;
        const double v = value.is_number() ? value.get<double>() : -1.0;
        if (!(v >= lowest && v <= highest))
            fail(fmt::format("a light has {} of {}, not within {} and {}", key, value.dump(), lowest, highest));
        return v;
    }

    void add(std::size_t l, std::size_t n, const glm::dmat4& frame) {
        const Json& light = (*lights_)[l];
        const Json& type = member(light, "type");
        const std::string node_name = member(nodes()[n], "name").is_string()
                                          ? member(nodes()[n], "name").get<std::string>()
                                          : std::string("light");
        if (type == "directional") {
            findings_.add(make_finding("SB801", fmt::format("{}: node {} ('{}')", name_, n, node_name),
                                       "a directional light stands for the sun; left out."));
            return;
        }
        if (type != "point" && type != "spot") fail(fmt::format("light {} has the type {}", l, type.dump()));
        // y up to z up: x = east, y = up, z = south.
        const auto turned = [](const glm::dvec4& v) { return Vec3d(v.x, -v.z, v.y); };
        Lamp lamp;
        lamp.id = fmt::format("{}#{}", node_name, n);
        lamp.position = Vec3f(turned(frame[3]) + offset_);
        lamp.intensity = static_cast<float>(number(light, "intensity", 1.0, 0.0, 1e12)) * Rgb(1.0f);
        if (const Json& value = member(light, "color"); !value.is_null()) {
            const std::vector<double> c = numbers(value, 3, fmt::format("the colour of light {}", l));
            for (int channel = 0; channel < 3; ++channel) {
                if (!(c[static_cast<std::size_t>(channel)] >= 0.0))
                    fail(fmt::format("light {} has a negative colour", l));
                lamp.intensity[channel] *= static_cast<float>(c[static_cast<std::size_t>(channel)]);
            }
        }
        if (type == "spot") {
            const Vec3d axis = turned(-frame[2]);
            if (!(glm::length(axis) > 0.0)) fail(fmt::format("node {} is scaled to nothing", n));
            const Json& spot = member(light, "spot");
            const double outer = number(spot, "outerConeAngle", kPi / 4.0, 1e-4, kPi / 2.0 + 1e-6);
            const double inner = number(spot, "innerConeAngle", 0.0, 0.0, outer);
            lamp.type = Lamp::Type::spot;
            lamp.axis = Vec3f(glm::normalize(axis));
            lamp.cone_half_angle_rad = static_cast<float>(outer);
            lamp.blend_rad = static_cast<float>(outer - inner);
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (!std::isfinite(lamp.position[axis])) fail(fmt::format("node {} stands nowhere", n));
        }
        out_.lamps.push_back(std::move(lamp));
    }

    const Json& gltf_;
    std::string name_;
    FindingLog& findings_;
    const Json* lights_ = nullptr;
    Vec3d offset_{0.0};
    LampFile out_;
};

}  // namespace

LampFile lamps_of_gltf(const Json& gltf, const std::filesystem::path& path, const Vec3d& origin,
                       const std::optional<Vec3d>& gltf_origin, FindingLog& findings) {
    LampFile file = GltfLights(gltf, path.string(), findings).read(origin, gltf_origin);
    file.files.push_back(path);
    return file;
}

}  // namespace skybake::io
