#include "study/surface_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

namespace skybake {
namespace {

const double kUprightSine = std::sin(radians_from_degrees(10.0));
const double kCoplanarCosine = std::cos(radians_from_degrees(1.0));
constexpr double kCoplanarM = 0.02;

struct Corner {
    Vec3d position;
    double u = 0.0, v = 0.0;
};

Vec3d normal_of(const std::array<Vec3f, 3>& t) {
    return glm::cross(Vec3d(t[1]) - Vec3d(t[0]), Vec3d(t[2]) - Vec3d(t[0]));
}

/// Twice the face's area along its normal.
Vec3d area_vector_of(const Scene& scene, const Face& face) {
    Vec3d sum(0.0);
    for (std::uint32_t t = 0; t < face.triangle_count; ++t) sum += normal_of(scene.triangles[face.first_triangle + t]);
    return sum;
}

bool is_of_kind(ReceiverKind kind, SurfaceType type, const Vec3d& normal) {
    const bool is_named = type != SurfaceType::unknown && type != SurfaceType::other;
    switch (kind) {
        case ReceiverKind::window:
            return type == SurfaceType::window;
        case ReceiverKind::facade:
            return is_named ? type == SurfaceType::wall : std::abs(normal.z) <= kUprightSine;
        case ReceiverKind::roof:
            return is_named ? (type == SurfaceType::roof || type == SurfaceType::floor) && normal.z > 0.0
                            : normal.z > kUprightSine;
        default:
            return false;
    }
}

/// Faces of one object that are one surface to the eye.
struct Patch {
    std::uint32_t object = 0;
    std::uint32_t surface = 0;
    std::vector<std::uint32_t> faces;
};

/// Joins faces of an object that share an edge and lie in one plane; sorted by object and lowest source index.
std::vector<Patch> patches_of(const Scene& scene, std::span<const std::uint32_t> faces,
                              std::span<const Vec3d> normals) {
    std::vector<std::uint32_t> parent(faces.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    using Millimetres = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
    const auto key = [](const Vec3f& p) {
        return Millimetres(std::llround(p.x * 1e3), std::llround(p.y * 1e3), std::llround(p.z * 1e3));
    };
    std::map<std::tuple<std::uint32_t, Millimetres, Millimetres>, std::vector<std::uint32_t>> faces_of_edge;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        const Face& face = scene.faces[faces[i]];
        for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
            const auto& triangle = scene.triangles[face.first_triangle + t];
            for (int k = 0; k < 3; ++k) {
                auto ends = std::minmax(key(triangle[k]), key(triangle[(k + 1) % 3]));
                std::vector<std::uint32_t>& sharers = faces_of_edge[{face.object, ends.first, ends.second}];
                for (const std::uint32_t other : sharers) {
                    const Vec3d other_point(scene.triangles[scene.faces[faces[other]].first_triangle][0]);
                    const bool is_coplanar =
                        glm::dot(normals[i], normals[other]) >= kCoplanarCosine &&
                        std::abs(glm::dot(normals[i], other_point - Vec3d(triangle[0]))) <= kCoplanarM;
                    if (is_coplanar) parent[root(i)] = root(other);
                }
                sharers.push_back(i);
            }
        }
    }
    std::map<std::uint32_t, Patch> by_root;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        const Face& face = scene.faces[faces[i]];
        Patch& patch = by_root.try_emplace(root(i), Patch{face.object, face.source_index, {}}).first->second;
        patch.surface = std::min(patch.surface, face.source_index);
        patch.faces.push_back(faces[i]);
    }
    std::vector<Patch> patches;
    for (auto& [r, patch] : by_root) patches.push_back(std::move(patch));
    std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
        return std::tie(a.object, a.surface, a.faces[0]) < std::tie(b.object, b.surface, b.faces[0]);
    });
    return patches;
}

/// The part of a convex polygon between two values of one plane coordinate.
std::vector<Corner> slab(const std::vector<Corner>& polygon, double Corner::*coordinate, double lo, double hi) {
    std::vector<Corner> in = polygon, out;
    for (const auto& [limit, sign] : {std::pair{lo, 1.0}, std::pair{hi, -1.0}}) {
        out.clear();
        for (std::size_t i = 0; i < in.size(); ++i) {
            const Corner& a = in[i];
            const Corner& b = in[(i + 1) % in.size()];
            const double da = sign * (a.*coordinate - limit), db = sign * (b.*coordinate - limit);
            if (da >= 0.0) out.push_back(a);
            if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
                const double s = da / (da - db);
                out.push_back(
                    {a.position + s * (b.position - a.position), a.u + s * (b.u - a.u), a.v + s * (b.v - a.v)});
            }
        }
        in = out;
    }
    return in;
}

/// What the pieces of a patch add up to within one cell.
struct CellSum {
    double area = 0.0, largest = 0.0;
    Vec3d weighted{0.0}, largest_centroid{0.0};
    Vec2d lo{1e30}, hi{-1e30};
    std::vector<std::vector<Corner>> pieces;
};

bool contains(const std::vector<Corner>& polygon, const Vec2d& p) {
    bool has_left = false, has_right = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner& a = polygon[i];
        const Corner& b = polygon[(i + 1) % polygon.size()];
        const double side = (b.u - a.u) * (p.y - a.v) - (b.v - a.v) * (p.x - a.u);
        has_left |= side > 0.0;
        has_right |= side < 0.0;
    }
    return !(has_left && has_right);
}

void add_piece(CellSum& cell, std::vector<Corner> piece) {
    double area = 0.0;
    Vec3d weighted(0.0);
    for (std::size_t i = 2; i < piece.size(); ++i) {
        const double a = 0.5 * glm::length(glm::cross(piece[i - 1].position - piece[0].position,
                                                      piece[i].position - piece[0].position));
        area += a;
        weighted += a * (piece[0].position + piece[i - 1].position + piece[i].position) / 3.0;
    }
    if (!(area > 0.0)) return;
    cell.area += area;
    cell.weighted += weighted;
    if (area > cell.largest) {
        cell.largest = area;
        cell.largest_centroid = weighted / area;
    }
    for (const Corner& c : piece) {
        cell.lo = glm::min(cell.lo, Vec2d(c.u, c.v));
        cell.hi = glm::max(cell.hi, Vec2d(c.u, c.v));
    }
    cell.pieces.push_back(std::move(piece));
}

/// Plane coordinates of a patch: u level, v up the slope; both metres in the scene's frame.
struct PatchFrame {
    Vec3d normal, u, v;
};
PatchFrame frame_of(const Vec3d& area_vector) {
    PatchFrame frame;
    frame.normal = glm::normalize(area_vector);
    const Vec3d level = glm::cross(Vec3d(0, 0, 1), frame.normal);
    frame.u = glm::length(level) > 1e-6 ? glm::normalize(level) : Vec3d(1, 0, 0);
    frame.v = glm::cross(frame.normal, frame.u);
    return frame;
}

/// Cells smaller than this share of a whole one are crumbs of clipping.
constexpr double kLeastAreaM2 = 1e-4;

/// Cuts a patch at `cell` along u and at the lines of `row_at` along v.
std::map<std::tuple<int, int, int>, CellSum> cut_patch(const Scene& scene, const Patch& patch, const PatchFrame& frame,
                                                       double foot_v, double storey_v, double cell_m) {
    double u_lo = 1e30, u_hi = -1e30, v_lo = 1e30, v_hi = -1e30;
    std::vector<std::vector<Corner>> triangles;
    for (const std::uint32_t f : patch.faces) {
        const Face& face = scene.faces[f];
        for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
            std::vector<Corner> triangle;
            for (const Vec3f& p : scene.triangles[face.first_triangle + t]) {
                triangle.push_back({Vec3d(p), glm::dot(Vec3d(p), frame.u), glm::dot(Vec3d(p), frame.v)});
                u_lo = std::min(u_lo, triangle.back().u), u_hi = std::max(u_hi, triangle.back().u);
                v_lo = std::min(v_lo, triangle.back().v), v_hi = std::max(v_hi, triangle.back().v);
            }
            triangles.push_back(std::move(triangle));
        }
    }
    // Whole cells from edge to edge, and within each storey (or, without storeys, from foot to top).
    const int columns = std::max(1, static_cast<int>(std::ceil((u_hi - u_lo) / cell_m - 1e-3)));
    const double width = (u_hi - u_lo) / columns;
    const bool has_storeys = storey_v > 0.0;
    const double base = has_storeys ? foot_v : v_lo;
    const double storey = has_storeys ? storey_v : v_hi - v_lo;
    const int rows = std::max(1, static_cast<int>(std::ceil(storey / cell_m - 1e-3)));
    const double height = storey / rows;
    std::map<std::tuple<int, int, int>, CellSum> cells;  // storey, column, row
    for (const std::vector<Corner>& triangle : triangles) {
        double lo = 1e30, hi = -1e30;
        for (const Corner& c : triangle) lo = std::min(lo, c.v), hi = std::max(hi, c.v);
        const int first = static_cast<int>(std::floor((lo - base) / height));
        const int last = static_cast<int>(std::floor((hi - base) / height));
        for (int r = first; r <= last; ++r) {
            const std::vector<Corner> band = slab(triangle, &Corner::v, base + r * height, base + (r + 1) * height);
            if (band.size() < 3) continue;
            double left = 1e30, right = -1e30;
            for (const Corner& c : band) left = std::min(left, c.u), right = std::max(right, c.u);
            const int from = static_cast<int>(std::floor((left - u_lo) / width));
            const int to = static_cast<int>(std::floor((right - u_lo) / width));
            for (int c = from; c <= to; ++c) {
                std::vector<Corner> piece = slab(band, &Corner::u, u_lo + c * width, u_lo + (c + 1) * width);
                if (piece.size() < 3) continue;
                const int level = static_cast<int>(std::floor(static_cast<double>(r) / rows));
                add_piece(cells[{has_storeys ? level : 0, c, r}], std::move(piece));
            }
        }
    }
    return cells;
}

Sample sample_of(const CellSum& cell, const PatchFrame& frame, const Scene& scene, std::uint32_t receiver) {
    const Vec3d mean = cell.weighted / cell.area;
    const Vec2d in_plane(glm::dot(mean, frame.u), glm::dot(mean, frame.v));
    const bool is_inside = std::any_of(cell.pieces.begin(), cell.pieces.end(),
                                       [&](const std::vector<Corner>& piece) { return contains(piece, in_plane); });
    const Vec3d point = is_inside ? mean : cell.largest_centroid;
    Sample sample;
    sample.position = scene.origin + point;
    sample.normal = Vec3f(frame.normal);
    sample.area_m2 = static_cast<float>(cell.area);
    sample.corner =
        Vec3f((cell.lo.x - glm::dot(point, frame.u)) * frame.u + (cell.lo.y - glm::dot(point, frame.v)) * frame.v);
    sample.u = Vec3f((cell.hi.x - cell.lo.x) * frame.u);
    sample.v = Vec3f((cell.hi.y - cell.lo.y) * frame.v);
    sample.receiver = receiver;
    return sample;
}

}  // namespace

void add_surface_cells(ReceiverSet& set, const Scene& scene, ReceiverKind kind, const ReceiverOptions& options) {
    const std::unordered_set<std::string> excluded(options.excluded_objects.begin(), options.excluded_objects.end());
    std::unordered_map<std::string, double> foot_of_building;
    std::vector<std::uint32_t> faces;
    std::vector<Vec3d> normals;
    for (std::uint32_t f = 0; f < scene.faces.size(); ++f) {
        const Face& face = scene.faces[f];
        const SceneObject& object = scene.objects[face.object];
        if (!is_building(object.type)) continue;
        const Vec3d area_vector = area_vector_of(scene, face);
        if (!(glm::length(area_vector) > 0.0)) continue;
        const Vec3d normal = glm::normalize(area_vector);
        if (is_of_kind(ReceiverKind::facade, face.type, normal)) {
            double& foot = foot_of_building.try_emplace(object.building_id, 1e30).first->second;
            for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
                for (const Vec3f& p : scene.triangles[face.first_triangle + t])
                    foot = std::min(foot, static_cast<double>(p.z));
            }
        }
        if (excluded.contains(object.id) || excluded.contains(object.building_id)) continue;
        if (!is_of_kind(kind, face.type, normal)) continue;
        faces.push_back(f);
        normals.push_back(normal);
    }
    for (const Patch& patch : patches_of(scene, faces, normals)) {
        Vec3d area_vector(0.0);
        for (const std::uint32_t f : patch.faces) area_vector += area_vector_of(scene, scene.faces[f]);
        if (!(glm::length(area_vector) > 0.0)) continue;
        const PatchFrame frame = frame_of(area_vector);
        const SceneObject& object = scene.objects[patch.object];
        // Storeys are level: along a leaning wall's v they are longer, and their line depends on where the wall stands.
        double foot_v = 0.0, storey_v = 0.0;
        if (kind == ReceiverKind::facade) {
            const Vec3d on_wall(scene.triangles[scene.faces[patch.faces[0]].first_triangle][0]);
            const double rise = frame.v.z;  // height gained along v
            storey_v = options.storey_height_m / rise;
            foot_v = glm::dot(on_wall, frame.v) + (foot_of_building.at(object.building_id) - on_wall.z) / rise;
        }
        std::vector<std::uint32_t> polygons;
        for (const std::uint32_t f : patch.faces) polygons.push_back(scene.faces[f].source_index);
        std::sort(polygons.begin(), polygons.end());
        polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
        std::optional<int> storey;
        for (const auto& [place, cell] : cut_patch(scene, patch, frame, foot_v, storey_v, options.cell_m)) {
            if (cell.area < kLeastAreaM2) continue;
            const int level = std::get<0>(place);
            if (!storey || *storey != level) {
                storey = level;
                Receiver receiver;
                receiver.kind = kind;
                receiver.building_id = object.building_id;
                receiver.object_id = object.id;
                receiver.surface = patch.surface;
                receiver.polygons = polygons;
                receiver.id = fmt::format("{}/{}", object.id, patch.surface);
                if (kind == ReceiverKind::facade) {
                    receiver.storey = level;
                    receiver.id += fmt::format("/{}", level);
                }
                receiver.sample_begin = static_cast<std::uint32_t>(set.samples.size());
                set.receivers.push_back(std::move(receiver));
            }
            set.samples.push_back(sample_of(cell, frame, scene, static_cast<std::uint32_t>(set.receivers.size() - 1)));
            set.receivers.back().sample_end = static_cast<std::uint32_t>(set.samples.size());
        }
    }
}

}  // namespace skybake
