#include "study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/check.h"
#include "study/light_incidence.h"
#include "study/sky_shares.h"

namespace skybake {
namespace {

/// Collects the columns of one state of the city.
class StateColumns {
  public:
    StateColumns(Study& study, const std::vector<Metric>& metrics, bool is_before)
        : study_(study), metrics_(metrics), is_before_(is_before) {}

    bool wants(Metric metric) const {
        // Sun that is lost has no former state.
        if (is_before_ && metric == Metric::new_shadow_hours) return false;
        return std::find(metrics_.begin(), metrics_.end(), metric) != metrics_.end();
    }
    bool wants_any(std::initializer_list<Metric> some) const {
        return std::any_of(some.begin(), some.end(), [&](Metric m) { return wants(m); });
    }
    void add(Metric metric, std::vector<float> values) {
        put(metric, std::move(values), "", std::nullopt, std::nullopt);
    }
    void add_day(Metric metric, std::vector<float> values, std::size_t day) {
        const CalendarDay date = study_.days[day].day();
        put(metric, std::move(values), fmt::format("_{:02}-{:02}", date.month, date.day), day, std::nullopt);
    }
    void add_instant(Metric metric, std::vector<float> values, std::size_t instant) {
        put(metric, std::move(values), fmt::format("_{}", study_.instants[instant]), std::nullopt, instant);
    }

  private:
    void put(Metric metric, std::vector<float> values, const std::string& moment, std::optional<std::size_t> day,
             std::optional<std::size_t> instant) {
        if (!wants(metric)) return;
        Column column{metric, day, instant, is_before_, std::move(values), {}};
        column.name = fmt::format("{}{}{}", is_before_ ? "before_" : "", name_of(metric), moment);
        study_.columns.push_back(std::move(column));
    }

    Study& study_;
    const std::vector<Metric>& metrics_;
    bool is_before_;
};

void add_durations(StateColumns& columns, const SunIntervals& intervals, const Study& study, std::size_t day,
                   double min_run_s) {
    const std::size_t n = study.receivers.samples.size();
    std::vector<float> sun(n), longest_sun(n), shadow(n), longest_shadow(n);
    for (std::size_t i = 0; i < n; ++i) {
        const SunDuration d = duration_of(intervals.of(i), study.days[day], min_run_s);
        sun[i] = static_cast<float>(d.sun_h);
        longest_sun[i] = static_cast<float>(d.longest_sun_h);
        shadow[i] = static_cast<float>(d.shadow_h);
        longest_shadow[i] = static_cast<float>(d.longest_shadow_h);
    }
    columns.add_day(Metric::sun_hours, std::move(sun), day);
    columns.add_day(Metric::longest_sun_hours, std::move(longest_sun), day);
    columns.add_day(Metric::shadow_hours, std::move(shadow), day);
    columns.add_day(Metric::longest_shadow_hours, std::move(longest_shadow), day);
}

std::vector<ReceiverPoint> receiver_points(const std::vector<Sample>& samples, const Vec3d& origin) {
    std::vector<ReceiverPoint> points;
    for (const Sample& s : samples) points.push_back({Vec3f(s.position - origin), s.normal});
    return points;
}

/// What surfaces reflect to the samples, in the daylight's unit, weighed as luminance.
std::vector<float> reflected(const std::vector<Sample>& samples, Daylight daylight, const StudyCity& city,
                             const PathOptions& paths, Progress& progress) {
    const LightSources sources{std::move(daylight), {}};
    const PathReference reference(sources, *city.scene, *city.rays, paths);
    std::vector<float> values;
    for (const IndirectLight& light : reference.light(receiver_points(samples, city.scene->origin), progress))
        values.push_back(luminance(light.irradiance));
    return values;
}

/// Illuminance by the estimators of `skybake probe`.
void add_instants(StateColumns& columns, Study& study, const StudyCity& city, const StudySettings& settings,
                  Progress& progress) {
    const std::vector<Sample>& samples = study.receivers.samples;
    for (std::size_t k = 0; k < settings.instants.size(); ++k) {
        const Daylight& daylight = settings.instants[k];
        std::vector<float> sun, sky, total;
        const DomeSampler sampler(std::span(&daylight, 1));
        progress.begin("sun and sky", 1);
        for (const PointLight& light : light_points(receiver_points(samples, city.scene->origin), sampler, 0,
                                                    daylight.sun, *city.rays, {settings.sky_directions, 64})) {
            sun.push_back(luminance(light.sun));
            sky.push_back(luminance(light.sky));
            total.push_back(sun.back() + sky.back());
        }
        progress.advance(1);
        if (columns.wants_any({Metric::indirect_lx, Metric::illuminance_lx})) {
            std::vector<float> indirect = reflected(samples, daylight, city, settings.paths, progress);
            for (std::size_t i = 0; i < total.size(); ++i) total[i] += indirect[i];
            columns.add_instant(Metric::indirect_lx, std::move(indirect), k);
        }
        columns.add_instant(Metric::sun_lx, std::move(sun), k);
        columns.add_instant(Metric::sky_lx, std::move(sky), k);
        columns.add_instant(Metric::illuminance_lx, std::move(total), k);
    }
}

void add_static(StateColumns& columns, Study& study, const Rule& rule, const StudyCity& city,
                const StudySettings& settings, Progress& progress) {
    const std::vector<Sample>& samples = study.receivers.samples;
    const Vec3d& origin = city.scene->origin;
    std::vector<float> energy;
    const bool wants_energy = columns.wants_any({Metric::sky_kwh_m2, Metric::irradiation_kwh_m2});
    if (wants_energy || columns.wants_any({Metric::sky_view_factor, Metric::sky_component_pct})) {
        const YearLight* year = wants_energy ? settings.year_light : nullptr;
        SkyShares shares = sky_shares(samples, origin, *city.rays, settings.sky_directions, year, progress);
        study.rays += shares.rays;
        energy = std::move(shares.sky_irradiation_kwh_m2);
        columns.add(Metric::sky_view_factor, std::move(shares.sky_view_factor));
        columns.add(Metric::sky_component_pct, std::move(shares.sky_component_pct));
        columns.add(Metric::sky_kwh_m2, energy);
    }
    if (columns.wants_any(
            {Metric::sunshine_pct, Metric::winter_sunshine_pct, Metric::beam_kwh_m2, Metric::irradiation_kwh_m2})) {
        SKYBAKE_CHECK(settings.year_light != nullptr);
        YearSun sun = year_sun(samples, origin, *city.rays, *settings.year_light, progress);
        study.rays += sun.rays;
        columns.add(Metric::sunshine_pct, std::move(sun.sunshine_pct));
        columns.add(Metric::winter_sunshine_pct, std::move(sun.winter_sunshine_pct));
        for (std::size_t i = 0; i < energy.size(); ++i) energy[i] += sun.beam_kwh_m2[i];
        columns.add(Metric::beam_kwh_m2, std::move(sun.beam_kwh_m2));
        columns.add(Metric::irradiation_kwh_m2, std::move(energy));
    }
    if (columns.wants(Metric::indirect_kwh_m2))
        columns.add(Metric::indirect_kwh_m2,
                    reflected(samples, daylight_of(*settings.year_light), city, settings.paths, progress));
    if (columns.wants(Metric::reflected_kwh_m2)) {
        // An open, level, diffuse ground: ρ G (1 − cos β)/2 for a surface tilted by β (Liu & Jordan 1963).
        const double leaving = settings.ground_albedo * settings.year_light->global_kwh_m2;
        std::vector<float> by_ground;
        for (const Sample& s : samples)
            by_ground.push_back(static_cast<float>(0.5 * leaving * (1.0 - static_cast<double>(s.normal.z))));
        columns.add(Metric::reflected_kwh_m2, std::move(by_ground));
    }
    if (columns.wants(Metric::light_incidence_deg)) {
        LightIncidence incidence = light_incidence(samples, origin, *city.rays, rule.swivel_deg, progress);
        study.rays += incidence.rays;
        columns.add(Metric::light_incidence_deg, std::move(incidence.angle_deg));
    }
}

void add_days(Study& study, const Rule& rule, StateColumns& columns, StateColumns* before_columns,
              const StudyCity& city, const std::optional<StudyCity>& before, const StudySettings& settings,
              Progress& progress) {
    const SunIntervalOptions options{settings.scan_s, rule.min_incidence_deg, rule.sampled};
    const std::vector<Sample>& samples = study.receivers.samples;
    const auto traced = [&](const StudyCity& state, std::size_t day) {
        const auto begin = std::chrono::steady_clock::now();
        SunIntervals found =
            sun_intervals(samples, study.days[day], state.scene->origin, *state.rays, options, progress);
        study.sun_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        study.sun_rays += found.rays;
        study.rays += found.rays;
        return found;
    };
    for (std::size_t day = 0; day < study.days.size(); ++day) {
        const SunIntervals after = traced(city, day);
        add_durations(columns, after, study, day, 60.0 * rule.min_run_min);
        if (!before) continue;
        const SunIntervals former = traced(*before, day);
        add_durations(*before_columns, former, study, day, 60.0 * rule.min_run_min);
        std::vector<float> lost(samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i) {
            for (const SunInterval& span : lost_sun(former.of(i), after.of(i)))
                lost[i] += (span.end_s - span.begin_s) / 3600.0f;
        }
        columns.add_day(Metric::new_shadow_hours, std::move(lost), day);
        const std::vector<NewShadow> shadows =
            new_shadows(study.receivers, static_cast<std::uint32_t>(day), former, after);
        study.new_shadows.insert(study.new_shadows.end(), shadows.begin(), shadows.end());
    }
}

/// A criterion's value over the days, for all samples; empty when no column has it.
std::vector<float> combined(const Study& study, const Criterion& criterion, bool is_before) {
    std::vector<float> value;
    std::size_t count = 0;
    // The day that is worst for the threshold decides under `each`, the best under `any`.
    const bool takes_least = (criterion.over_days == OverDays::each) != criterion.at_most.has_value();
    for (const Column& column : study.columns) {
        if (column.metric != criterion.metric || column.is_before != is_before) continue;
        if (++count == 1) {
            value = column.values;
            continue;
        }
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (criterion.over_days == OverDays::mean) {
                value[i] += column.values[i];
            } else {
                value[i] = takes_least ? std::min(value[i], column.values[i]) : std::max(value[i], column.values[i]);
            }
        }
    }
    if (criterion.over_days == OverDays::mean) {
        for (float& v : value) v /= static_cast<float>(count);
    }
    return value;
}

CriterionResult judged(const Study& study, const Criterion& criterion) {
    CriterionResult result;
    result.value = combined(study, criterion, false);
    const std::vector<float> before = combined(study, criterion, true);
    const std::size_t n = study.receivers.samples.size();
    SKYBAKE_CHECK_EQ(result.value.size(), n);
    result.margin.resize(n);
    result.verdict.assign(n, Verdict::none);
    if (!before.empty()) result.verdict_before.assign(n, Verdict::none);
    for (std::size_t i = 0; i < n; ++i) {
        const ReceiverKind kind = study.receivers.receivers[study.receivers.samples[i].receiver].kind;
        const bool is_asked = criterion.kinds.empty() ||
                              std::find(criterion.kinds.begin(), criterion.kinds.end(), kind) != criterion.kinds.end();
        if (!is_asked) continue;
        std::optional<double> former;
        if (!before.empty()) {
            former = static_cast<double>(before[i]);
            result.verdict_before[i] = judge(criterion, *former, std::nullopt).verdict;
        }
        const Judgement judgement = judge(criterion, static_cast<double>(result.value[i]), former);
        result.verdict[i] = judgement.verdict;
        result.margin[i] = static_cast<float>(judgement.margin);
    }
    return result;
}

}  // namespace

std::optional<std::size_t> former_column(const Study& study, std::size_t column) {
    for (std::size_t c = 0; c < study.columns.size(); ++c) {
        if (study.columns[c].is_before && study.columns[c].metric == study.columns[column].metric &&
            study.columns[c].day == study.columns[column].day &&
            study.columns[c].instant == study.columns[column].instant)
            return c;
    }
    return std::nullopt;
}

std::vector<SunDay> days_of(const Rule& rule, const StudySettings& settings) {
    std::vector<SunDay> days;
    for (const CalendarDay day : rule.days)
        days.emplace_back(settings.year, day, settings.site, settings.convergence_rad,
                          SunDayOptions{rule.window, rule.min_elevation_deg, settings.timezone});
    return days;
}

std::vector<CriterionResult> judged(const Rule& rule, const Study& study) {
    std::vector<CriterionResult> results;
    for (const Criterion& criterion : rule.criteria) results.push_back(judged(study, criterion));
    return results;
}

Study run_study(const Rule& rule, ReceiverSet receivers, std::vector<SunDay> days, const StudyCity& city,
                const std::optional<StudyCity>& before, const StudySettings& settings, Progress& progress) {
    Study study;
    study.receivers = std::move(receivers);
    study.days = std::move(days);
    for (const Daylight& daylight : settings.instants) study.instants.push_back(daylight.label);
    const std::vector<Metric> metrics = rule.all_metrics();
    StateColumns columns(study, metrics, false), before_columns(study, metrics, true);
    if (std::any_of(metrics.begin(), metrics.end(), is_of_days))
        add_days(study, rule, columns, &before_columns, city, before, settings, progress);
    add_static(columns, study, rule, city, settings, progress);
    if (before) add_static(before_columns, study, rule, *before, settings, progress);
    if (std::any_of(metrics.begin(), metrics.end(), is_of_instants)) {
        add_instants(columns, study, city, settings, progress);
        if (before) add_instants(before_columns, study, *before, settings, progress);
    }
    study.criteria = judged(rule, study);
    return study;
}

}  // namespace skybake
