#include "api/study_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"

namespace skybake {
namespace {

constexpr int kMapPixels = 1600;          // along the longer side: 220 dots an inch on a page
constexpr double kSurroundingsM = 200.0;  // about the plan
constexpr double kShadowMarginM = 15.0;
constexpr double kLowSunRad = 10.0 * kPi / 180.0;  // below, shadows leave any sheet
constexpr double kMostShadowNodes = 1.5e6;         // of the lattice of shadow outlines
constexpr std::size_t kMostChosenPoints = 6;       // that all get a sky of their own

Box2d box_of(const Scene& scene) {
    return {Vec2d(scene.origin) + Vec2d(Vec3d(scene.bounds.lo)), Vec2d(scene.origin) + Vec2d(Vec3d(scene.bounds.hi))};
}

Box2d grown(Box2d box, double margin) {
    return {box.lo - margin, box.hi + margin};
}

MapGround map_ground(const PreparedStudy& prepared, const Box2d& box) {
    const CityState& state = *prepared.after;
    MapGround map{plan_view(state.scene, state.rays, box.lo, box.hi, kMapPixels), {}, {}, {}};
    for (const SceneObject& object : state.scene.objects) {
        map.is_planned.push_back(std::binary_search(prepared.plan.begin(), prepared.plan.end(), object.id));
        map.building_ids.push_back(object.building_id);
        map.is_building.push_back(!is_ground(object.type));
    }
    return map;
}

std::vector<MapGround> maps_of(const PreparedStudy& prepared, const Study& study) {
    Box2d all;
    for (const Sample& sample : study.receivers.samples) all.extend(Vec2d(sample.position));
    if (prepared.planned) {
        const Box2d plan = box_of(prepared.planned->scene);
        all.extend(plan.lo), all.extend(plan.hi);
    }
    const Vec2d size = all.hi - all.lo;
    all = grown(all, std::max(5.0, 0.03 * std::max(size.x, size.y)));
    std::vector<MapGround> maps{map_ground(prepared, all)};
    if (prepared.planned) {
        Box2d near = grown(box_of(prepared.planned->scene), kSurroundingsM);
        near.lo = glm::max(near.lo, all.lo), near.hi = glm::min(near.hi, all.hi);
        const Vec2d part = near.hi - near.lo;
        if (std::max(part.x, part.y) < 0.75 * std::max(size.x, size.y)) maps.push_back(map_ground(prepared, near));
    }
    return maps;
}

/// What a sample loses by the plan in the rule's first metric that has a former state.
std::vector<float> losses(const Rule& rule, const Study& study) {
    std::vector<float> loss(study.receivers.samples.size());
    for (std::size_t c = 0; c < study.columns.size(); ++c) {
        const Column& column = study.columns[c];
        if (column.is_before || !traits_of(column.metric).prefers_more) continue;
        const std::optional<std::size_t> former = former_column(study, c);
        const bool is_asked = rule.criteria.empty() || column.metric == rule.criteria.front().metric ||
                              rule.criteria.front().metric == Metric::new_shadow_hours;
        if (!former || !is_asked) continue;
        for (std::size_t i = 0; i < loss.size(); ++i)
            loss[i] = std::max(loss[i], study.columns[*former].values[i] - column.values[i]);
    }
    return loss;
}

/// The first samples by a number, of different buildings.
void choose(std::vector<SamplePlate>& plates, const Study& study, const char* reason, std::size_t count,
            const std::vector<float>& rank) {
    std::vector<std::size_t> order(rank.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank[a] < rank[b]; });
    const auto place = [&](std::size_t i) {
        const Receiver& r = study.receivers.receivers[study.receivers.samples[i].receiver];
        return r.building_id.empty() ? r.id : r.building_id;
    };
    std::size_t chosen = 0;
    for (std::size_t k = 0; k < order.size() && chosen < count && std::isfinite(rank[order[k]]); ++k) {
        const bool is_known = std::any_of(plates.begin(), plates.end(),
                                          [&](const SamplePlate& p) { return place(p.sample) == place(order[k]); });
        if (is_known) continue;
        plates.push_back({order[k], reason, {}, {}, {}, {}});
        ++chosen;
    }
}

std::vector<SamplePlate> chosen_samples(const Rule& rule, const PreparedStudy& prepared, const Study& study) {
    std::vector<SamplePlate> plates;
    const std::vector<Sample>& samples = study.receivers.samples;
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (study.receivers.receivers[samples[i].receiver].kind == ReceiverKind::point) points.push_back(i);
    }
    if (!points.empty() && points.size() <= kMostChosenPoints) {
        for (const std::size_t i : points) plates.push_back({i, "chosen", {}, {}, {}, {}});
        return plates;
    }
    constexpr float kNever = std::numeric_limits<float>::infinity();
    if (prepared.former()) {
        std::vector<float> rank = losses(rule, study);
        for (float& r : rank) r = r > 0.0f ? -r : kNever;
        choose(plates, study, "loses most", 3, rank);
    }
    if (!study.criteria.empty()) {
        std::vector<float> nearest(samples.size(), kNever), worst(samples.size(), kNever);
        const CriterionResult& c = study.criteria.front();
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (c.verdict[i] == Verdict::none) continue;
            nearest[i] = std::abs(c.margin[i]);
            if (c.verdict[i] == Verdict::fail) worst[i] = c.margin[i];
        }
        choose(plates, study, "nearest to the threshold", 2, nearest);
        choose(plates, study, "worst", 1, worst);
    }
    return plates;
}

void fill_plates(std::vector<SamplePlate>& plates, const Rule& rule, const PreparedStudy& prepared,
                 const Study& study) {
    const SunIntervalOptions options{prepared.settings.scan_s, rule.min_incidence_deg, rule.sampled};
    const auto seen = [&](const StudyCity& state, const Sample& sample, Obstruction& dome,
                          std::vector<std::vector<SunInterval>>& sunny) {
        dome = obstruction_of(sample, state.scene->origin, *state.rays, prepared.settings.convergence_rad);
        SilentProgress silent;
        for (const SunDay& day : study.days) {
            const SunIntervals found =
                sun_intervals(std::span(&sample, 1), day, state.scene->origin, *state.rays, options, silent);
            sunny.emplace_back(found.of(0).begin(), found.of(0).end());
        }
    };
    for (SamplePlate& plate : plates) {
        const Sample& sample = study.receivers.samples[plate.sample];
        seen(prepared.city(), sample, plate.after, plate.sunny);
        if (!prepared.former()) continue;
        plate.before.emplace();
        seen(*prepared.former(), sample, *plate.before, plate.sunny_before);
    }
}

void add_shadows(StudyPictures& pictures, const Rule& rule, const PreparedStudy& prepared, const Study& study,
                 Progress& progress) {
    const StudySettings& settings = prepared.settings;
    const Scene& ground_scene = prepared.after->scene;
    const Box2d box = box_of(ground_scene);
    const Vec2d size = box.hi - box.lo;
    // Whole metres, so that the lattice says what it is.
    pictures.shadow_spacing_m = std::max(1.0, std::ceil(std::sqrt(size.x * size.y / kMostShadowNodes)));
    pictures.has_solar_clock = !settings.timezone;
    const ShadowGround ground(ground_scene, pictures.shadow_spacing_m, rule.height_m);
    progress.begin("shadow outlines", study.days.size());
    for (std::size_t d = 0; d < study.days.size(); ++d) {
        const SunDay& day = study.days[d];
        for (const WholeHour& hour : whole_hours(day, settings.site, settings.timezone)) {
            if (progress.stop_requested()) throw Interrupted();
            const Vec3f direction = day.direction(hour.second);
            const auto add = [&](ShadowKind kind, const StudyCity& city, const std::optional<StudyCity>& before) {
                pictures.shadows.push_back({d, hour.second, hour.clock, kind, ground.outline(city, before, direction)});
            };
            if (prepared.planned) add(ShadowKind::plan, prepared.planned->view(), std::nullopt);
            if (prepared.before) add(ShadowKind::added, prepared.after->view(), prepared.before->view());
            if (!prepared.before) add(ShadowKind::city, prepared.after->view(), std::nullopt);
        }
        progress.advance(1);
    }
}

/// The plan and its shadows while the sun is not low; without a plan all receivers.
MapGround shadow_map(const StudyPictures& pictures, const PreparedStudy& prepared, const Study& study) {
    if (!prepared.planned) return pictures.maps.front();
    Box2d box = box_of(prepared.planned->scene);
    for (const HourShadow& shadow : pictures.shadows) {
        const bool is_low = study.days[shadow.day].elevation_rad(shadow.second) < kLowSunRad;
        if (shadow.kind != ShadowKind::plan || is_low) continue;
        for (const std::vector<Vec2d>& ring : shadow.outline.rings) {
            for (const Vec2d& p : ring) box.extend(p);
        }
    }
    return map_ground(prepared, grown(box, kShadowMarginM));
}

}  // namespace

StudyPictures study_pictures(const Rule& rule, const PreparedStudy& prepared, const Study& study, Progress& progress) {
    StudyPictures pictures;
    pictures.maps = maps_of(prepared, study);
    pictures.plates = chosen_samples(rule, prepared, study);
    fill_plates(pictures.plates, rule, prepared, study);
    add_shadows(pictures, rule, prepared, study, progress);
    if (!pictures.shadows.empty()) pictures.shadow_map = shadow_map(pictures, prepared, study);
    return pictures;
}

}  // namespace skybake
