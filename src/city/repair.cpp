#include "city/repair.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "base/error.h"
#include "city/finding_codes.h"
#include "city/repair_steps.h"

namespace skybake {
namespace {

constexpr std::size_t kObjectsPerTask = 16;
/// An object whose middle is further than this from the median of all is no part of the city: no model of one city is
/// as wide.
constexpr double kFarAway = 200'000.0;

Box3d box_of(const CityObject& object) {
    Box3d box;
    for (const Vec3d& p : object.geometry.vertices) {
        if (repair_steps::is_place(p)) box.extend(p);
    }
    return box;
}

bool contains(const Box3d& outer, const Box3d& inner, int axis, double slack) {
    return inner.lo[axis] >= outer.lo[axis] - slack && inner.hi[axis] <= outer.hi[axis] + slack;
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void drop_far_objects(CityModel& city, FindingLog& findings) {
    std::vector<double> xs, ys;
    std::vector<Box3d> boxes;
    for (const CityObject& object : city.objects) {
        boxes.push_back(box_of(object));
        if (boxes.back().is_empty()) continue;
        xs.push_back(boxes.back().center().x);
        ys.push_back(boxes.back().center().y);
    }
    if (xs.size() < 3) return;
    const Vec2d median(median_of(xs), median_of(ys));
    for (std::size_t i = 0; i < city.objects.size(); ++i) {
        if (boxes[i].is_empty()) continue;
        const double distance = glm::distance(Vec2d(boxes[i].center()), median);
        if (distance <= kFarAway) continue;
        findings.add(
            make_finding("SB216", city.objects[i].where,
                         fmt::format("lies {:.0f} km away from the middle of the city; left out.", distance / 1000.0)));
        city.objects[i].geometry = Geometry();
    }
}

/// The objects of each building with more than one solid: the building first, then its parts in order.
std::vector<std::vector<const CityObject*>> families_of(const CityModel& city) {
    std::unordered_map<std::string, std::size_t> family_of;
    std::vector<std::vector<const CityObject*>> families;
    for (const CityObject& object : city.objects) {
        if (object.geometry.is_empty() || is_ground(object.type)) continue;
        const auto [entry, is_new] =
            family_of.emplace(object.parent_id.empty() ? object.id : object.parent_id, families.size());
        if (is_new) families.emplace_back();
        families[entry->second].push_back(&object);
    }
    return families;
}

template <typename Count, typename F>
void in_tasks(Count count, FindingLog& findings, Progress& progress, F&& f) {
    const std::size_t tasks = (count + kObjectsPerTask - 1) / kObjectsPerTask;
    std::vector<FindingLog> logs(tasks);
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
        if (progress.stop_requested()) return;
        const std::size_t end = std::min(count, (task + 1) * kObjectsPerTask);
        for (std::size_t i = task * kObjectsPerTask; i < end; ++i) f(i, logs[task]);
        progress.advance(end - task * kObjectsPerTask);
    });
    if (progress.stop_requested()) throw Interrupted();
    for (const FindingLog& log : logs) findings.merge(log);
}

}  // namespace

void drop_bad_coordinates(CityModel& city, std::size_t first_object, FindingLog& findings) {
    for (std::size_t i = first_object; i < city.objects.size(); ++i) {
        repair_steps::drop_bad_coordinates(city.objects[i], findings);
    }
}

void repair_offset(CityModel& city, std::size_t first_object, const Vec3d& translate,
                   const std::optional<Box3d>& stated, const std::string& file, FindingLog& findings) {
    if (!stated || stated->is_empty() || !std::isfinite(glm::length(stated->size()))) return;
    Box3d box;
    for (std::size_t i = first_object; i < city.objects.size(); ++i) box.extend(box_of(city.objects[i]));
    if (box.is_empty()) return;
    const Box3d moved{box.lo - translate, box.hi - translate};
    // A stated extent may be rounded, or have a margin; the slack is for those.
    const auto slack = [&](int axis) { return std::max(1.0, 0.05 * stated->size()[axis]); };
    const auto is_inside = [&](const Box3d& b, int axis) { return contains(*stated, b, axis, slack(axis)); };
    const bool is_doubled = !is_inside(box, 0) && !is_inside(box, 1) && is_inside(moved, 0) && is_inside(moved, 1);
    if (is_doubled) {
        Vec3d offset(translate.x, translate.y, 0.0);
        if (!is_inside(box, 2) && is_inside(moved, 2)) offset.z = translate.z;
        for (std::size_t i = first_object; i < city.objects.size(); ++i) {
            for (Vec3d& p : city.objects[i].geometry.vertices) p -= offset;
        }
        findings.add(make_finding("SB201", file,
                                  fmt::format("coordinates lie about ({:.0f}, {:.0f}, {:.0f}) outside the stated "
                                              "extent, because the transform's offset is in them already; it was "
                                              "taken off once.",
                                              offset.x, offset.y, offset.z)));
        return;
    }
    if (is_inside(box, 0) && is_inside(box, 1) && is_inside(box, 2)) return;
    findings.add(
        make_finding("SB215", file + ": #/metadata/geographicalExtent",
                     fmt::format("states ({:.1f}, {:.1f}, {:.1f}) to ({:.1f}, {:.1f}, {:.1f}), the coordinates go from "
                                 "({:.1f}, {:.1f}, {:.1f}) to ({:.1f}, {:.1f}, {:.1f}); ignored.",
                                 stated->lo.x, stated->lo.y, stated->lo.z, stated->hi.x, stated->hi.y, stated->hi.z,
                                 box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z)));
}

RepairSummary repair(CityModel& city, FindingLog& findings, Progress& progress) {
    drop_far_objects(city, findings);
    progress.begin("repair", 2 * city.objects.size());
    std::vector<RepairSummary> summaries(city.objects.size());
    in_tasks(city.objects.size(), findings, progress, [&](std::size_t i, FindingLog& log) {
        using namespace repair_steps;
        CityObject& object = city.objects[i];
        if (object.geometry.is_empty()) return;
        drop_bad_coordinates(object, log);
        merge_vertices(object, log);
        clean_rings(object, log);
        drop_repeated_surfaces(object, log);
        RepairSummary& summary = summaries[i];
        summary.triangles = split_crossing_rings(object, log);
        const ShellCounts shells = orient(object, log);
        infer_types(object);
        summary.surfaces = object.geometry.surfaces.size();
        summary.closed_shells = shells.closed;
        summary.open_shells = shells.open;
    });
    const auto families = families_of(city);
    in_tasks(families.size(), findings, progress,
             [&](std::size_t i, FindingLog& log) { repair_steps::note_overlaps(families[i], log); });

    RepairSummary total;
    for (const RepairSummary& summary : summaries) {
        total.surfaces += summary.surfaces;
        total.triangles += summary.triangles;
        total.closed_shells += summary.closed_shells;
        total.open_shells += summary.open_shells;
    }
    return total;
}

}  // namespace skybake
