// Based on: glTF 2.0 specification, section 3.5 (nodes and transformations); EXT_mesh_gpu_instancing.
#include "io/gltf/gltf_scene.h"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <utility>

#include "city/finding_codes.h"
#include "io/gltf/gltf_accessor.h"

namespace skybake::io {
namespace {

constexpr std::size_t kMostInstances = 1'000'000;

glm::dmat4 matrix_of(const Vec3d& translation, const glm::dquat& rotation, const Vec3d& scale) {
    return glm::scale(glm::translate(glm::dmat4(1.0), translation) * glm::mat4_cast(glm::normalize(rotation)), scale);
}

glm::dmat4 matrix_of(const GltfJson& node) {
    if (const auto m = numbers_at(node, "matrix", 16)) return glm::make_mat4(m->data());
    const auto t = numbers_at(node, "translation", 3).value_or(std::vector<double>{0, 0, 0});
    const auto r = numbers_at(node, "rotation", 4).value_or(std::vector<double>{0, 0, 0, 1});
    const auto s = numbers_at(node, "scale", 3).value_or(std::vector<double>{1, 1, 1});
    return matrix_of({t[0], t[1], t[2]}, glm::dquat(r[3], r[0], r[1], r[2]), {s[0], s[1], s[2]});
}

class SceneReader {
  public:
    SceneReader(const GltfDocument& document, std::string name, FindingLog& findings)
        : document_(document), name_(std::move(name)), findings_(findings) {}

    std::vector<GltfInstance> read() {
        const GltfJson& nodes = member(document_.json(), "nodes");
        const std::size_t count = nodes.is_array() ? nodes.size() : 0;
        is_seen_.assign(count, false);
        // Depth first without recursion: chains of strangers may be long.
        std::vector<std::pair<std::size_t, glm::dmat4>> open;
        const std::vector<std::size_t> roots = roots_of(nodes, count);
        for (std::size_t i = roots.size(); i-- > 0;) open.emplace_back(roots[i], glm::dmat4(1.0));
        while (!open.empty()) {
            const auto [index, parent] = open.back();
            open.pop_back();
            const std::string where = fmt::format("{}: nodes[{}]", name_, index);
            if (index >= count || is_seen_[index]) {
                fault(where, index >= count ? "does not exist" : "hangs on two parents, or on itself");
                continue;
            }
            is_seen_[index] = true;
            try {
                const glm::dmat4 to_asset = parent * matrix_of(nodes[index]);
                const GltfJson& children = member(nodes[index], "children");
                for (std::size_t i = children.is_array() ? children.size() : 0; i-- > 0;) {
                    if (children[i].is_number_unsigned()) open.emplace_back(children[i].get<std::size_t>(), to_asset);
                }
                if (const auto mesh = index_at(nodes[index], "mesh")) add(nodes[index], index, *mesh, to_asset, where);
            } catch (const GltfFault& thrown) {
                fault(where, thrown.what());
            }
        }
        return std::move(instances_);
    }

  private:
    void fault(const std::string& where, std::string_view what) {
        findings_.add(make_finding("SB101", where, fmt::format("{}; left out.", what)));
    }

    std::vector<std::size_t> roots_of(const GltfJson& nodes, std::size_t count) {
        std::vector<std::size_t> roots;
        const GltfJson& scenes = member(document_.json(), "scenes");
        const GltfJson& chosen = member(document_.json(), "scene");
        const std::size_t scene = chosen.is_number_unsigned() ? chosen.get<std::size_t>() : 0;
        if (scenes.is_array() && scene < scenes.size()) {
            const GltfJson& list = member(scenes[scene], "nodes");
            for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
                if (list[i].is_number_unsigned()) roots.push_back(list[i].get<std::size_t>());
            }
            return roots;
        }
        std::vector<bool> is_child(count, false);
        for (std::size_t n = 0; n < count; ++n) {
            const GltfJson& children = member(nodes[n], "children");
            for (std::size_t i = 0; children.is_array() && i < children.size(); ++i) {
                if (children[i].is_number_unsigned() && children[i].get<std::size_t>() < count)
                    is_child[children[i].get<std::size_t>()] = true;
            }
        }
        for (std::size_t n = 0; n < count; ++n) {
            if (!is_child[n]) roots.push_back(n);
        }
        return roots;
    }

    void add(const GltfJson& node, std::size_t index, std::size_t mesh, const glm::dmat4& to_asset,
             const std::string& where) {
        std::string name = text_at(node, "name");
        if (name.empty()) name = text_at(entry(document_.json(), "meshes", mesh), "name");
        if (name.empty()) name = fmt::format("node {}", index);
        const std::vector<glm::dmat4> places = instances_of(node);
        if (instances_.size() + places.size() > kMostInstances)
            return fault(where, fmt::format("more than {} instances of meshes", kMostInstances));
        for (std::size_t i = 0; i < places.size(); ++i) {
            instances_.push_back(
                {mesh, places.size() > 1 ? fmt::format("{} {}", name, i + 1) : name, to_asset * places[i]});
        }
    }

    /// Where EXT_mesh_gpu_instancing puts the mesh below its node; without it once, at the node.
    std::vector<glm::dmat4> instances_of(const GltfJson& node) const {
        const GltfJson& attributes =
            member(member(member(node, "extensions"), "EXT_mesh_gpu_instancing"), "attributes");
        if (attributes.is_null()) return {glm::dmat4(1.0)};
        std::optional<std::size_t> count;
        const auto array = [&](std::string_view key, std::size_t components) {
            const auto accessor = index_at(attributes, key);
            GltfArray values = accessor ? read_accessor(document_, *accessor) : GltfArray{components, {}};
            if (accessor && (values.components != components || (count && *count != values.count())))
                throw GltfFault("attributes of EXT_mesh_gpu_instancing do not fit each other");
            if (accessor) count = values.count();
            return values.values;
        };
        const std::vector<double> t = array("TRANSLATION", 3), r = array("ROTATION", 4), s = array("SCALE", 3);
        std::vector<glm::dmat4> places;
        for (std::size_t i = 0; i < std::min(count.value_or(0), kMostInstances + 1); ++i) {
            const auto vector = [&](const std::vector<double>& list, double absent) {
                return list.empty() ? Vec3d(absent) : Vec3d(list[3 * i], list[3 * i + 1], list[3 * i + 2]);
            };
            const glm::dquat rotation =
                r.empty() ? glm::dquat(1, 0, 0, 0) : glm::dquat(r[4 * i + 3], r[4 * i], r[4 * i + 1], r[4 * i + 2]);
            places.push_back(matrix_of(vector(t, 0.0), rotation, vector(s, 1.0)));
        }
        return places;
    }

    const GltfDocument& document_;
    std::string name_;
    FindingLog& findings_;
    std::vector<bool> is_seen_;
    std::vector<GltfInstance> instances_;
};

}  // namespace

std::vector<GltfInstance> read_scene(const GltfDocument& document, const std::string& name, FindingLog& findings) {
    return SceneReader(document, name, findings).read();
}

}  // namespace skybake::io
