// Each shipped rule on a scene whose value is known by hand: at its threshold, a little above and a little below.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <tuple>

#include "api/study_city.h"
#include "base/error.h"
#include "io/rules/read_rule.h"
#include "sky/solar_position.h"
#include "study/roll_up.h"
#include "study/study_scenes.h"

namespace skybake {
namespace {

const std::filesystem::path kRules = SKYBAKE_RULES;

Rule rule_named(const std::string& name) {
    return io::read_rule(kRules / (name + ".json"));
}

StudySettings settings_at(const Site& site) {
    StudySettings settings;
    settings.site = site;
    settings.timezone = "Europe/Vienna";
    return settings;
}

/// The verdict of a rule's criterion at one point.
Verdict verdict(const Rule& rule, std::size_t criterion, QuadScene quads, const Sample& sample, StudySettings settings,
                const YearLight* year = nullptr, QuadScene* before = nullptr) {
    ReceiverSet set = point_at_origin(sample.normal, sample.position);
    settings.year_light = year;
    const Scene scene = quads.scene();
    const RayScene rays(scene);
    std::optional<Scene> former;
    std::optional<RayScene> former_rays;
    std::optional<StudyCity> former_city;
    if (before) {
        former.emplace(before->scene());
        former_rays.emplace(*former);
        former_city = StudyCity{&*former, &*former_rays};
    }
    SilentProgress silent;
    const Study study = run_study(rule, set, days_of(rule, settings), {&scene, &rays}, former_city, settings, silent);
    return study.criteria[criterion].verdict[0];
}

/// In [0, 2π), so that it rises from morning to evening.
double azimuth_at(const SunDay& day, double second) {
    const Vec3f d = day.direction(std::clamp(second, 0.0, static_cast<double>(day.length_s())));
    const double azimuth = std::atan2(static_cast<double>(d.x), static_cast<double>(d.y));
    return azimuth < 0.0 ? azimuth + 2.0 * kPi : azimuth;
}

/// Screens about the origin that leave open the azimuths of the sun within `hours` about the middle of the window.
QuadScene open_for(const SunDay& day, double hours) {
    QuadScene quads;
    const double middle = 0.5 * (day.spans().front().begin_s + day.spans().back().end_s);
    const double from = azimuth_at(day, middle - 1800.0 * hours), to = azimuth_at(day, middle + 1800.0 * hours);
    add_screen(quads, to, from + 2.0 * kPi);
    return quads;
}

/// A screen that hides the sun within `hours` about the middle of the window.
QuadScene hidden_for(const SunDay& day, double hours) {
    QuadScene quads;
    const double middle = 0.5 * (day.spans().front().begin_s + day.spans().back().end_s);
    add_screen(quads, azimuth_at(day, middle - 1800.0 * hours), azimuth_at(day, middle + 1800.0 * hours));
    return quads;
}

constexpr double kSixMinutes = 0.1;
/// "Some sun": less than its threshold cannot be told by six minutes.
double step_of(double hours) {
    return std::min(kSixMinutes, 0.75 * hours);
}

struct HoursCase {
    const char* rule;
    std::size_t criterion;
    double hours;
};
void PrintTo(const HoursCase& c, std::ostream* out) {
    *out << c.rule << '/' << c.criterion;
}

class SunHoursRule : public testing::TestWithParam<HoursCase> {};
INSTANTIATE_TEST_SUITE_P(Shipped, SunHoursRule,
                         testing::Values(HoursCase{"en17037-sunlight", 0, 1.5}, HoursCase{"en17037-sunlight", 1, 3.0},
                                         HoursCase{"en17037-sunlight", 2, 4.0}, HoursCase{"bre209-amenity", 0, 2.0},
                                         HoursCase{"din5034-january", 0, 1.0}, HoursCase{"din5034-equinox", 0, 4.0},
                                         HoursCase{"gb50180-great-cold", 0, 2.0},
                                         HoursCase{"gb50180-great-cold-3h", 0, 3.0},
                                         HoursCase{"gb50180-winter-solstice", 0, 1.0}, HoursCase{"tno-light", 0, 2.0},
                                         HoursCase{"tno-strict", 0, 3.0}, HoursCase{"hague-norm", 0, 2.0},
                                         HoursCase{"nsw-adg", 0, 2.0}, HoursCase{"nsw-adg", 1, 0.02},
                                         HoursCase{"montreal-consecutive", 0, 1.0}));

TEST_P(SunHoursRule, AtAboveAndBelow) {
    const HoursCase& c = GetParam();
    Rule rule = rule_named(c.rule);
    ASSERT_EQ(rule.criteria[c.criterion].at_least, c.hours);
    rule.days.resize(1);  // one screen fits one day
    const StudySettings settings = settings_at(graz());
    const SunDay day = std::move(days_of(rule, settings).front());
    const Sample up = sample_at({0, 0, 0}, {0, 0, 1});
    EXPECT_EQ(verdict(rule, c.criterion, open_for(day, c.hours), up, settings), Verdict::borderline);
    EXPECT_EQ(verdict(rule, c.criterion, open_for(day, c.hours + step_of(c.hours)), up, settings), Verdict::pass);
    EXPECT_EQ(verdict(rule, c.criterion, open_for(day, c.hours - step_of(c.hours)), up, settings), Verdict::fail);
}

TEST(ShippedRules, JapanCountsShadowByTrueSolarTime) {
    for (const auto& [name, hours] : {std::pair{"japan-bsl56-2-near", 3.0}, {"japan-bsl56-2-far", 2.0}}) {
        const Rule rule = rule_named(name);
        const StudySettings settings = settings_at({radians_from_degrees(35.68), radians_from_degrees(139.77), 0.0});
        const std::vector<SunDay> days = days_of(rule, settings);
        const Sample up = sample_at({0, 0, 4}, {0, 0, 1});
        // True solar days are up to 30 s longer than 24 h: 10 s in eight hours, and the rounding to whole seconds.
        EXPECT_NEAR(days[0].hours(), 8.0, 11.0 / 3600.0);
        EXPECT_EQ(verdict(rule, 0, hidden_for(days[0], hours), up, settings), Verdict::borderline);
        EXPECT_EQ(verdict(rule, 0, hidden_for(days[0], hours - kSixMinutes), up, settings), Verdict::pass);
        EXPECT_EQ(verdict(rule, 0, hidden_for(days[0], hours + kSixMinutes), up, settings), Verdict::fail);
    }
}

/// Hourly from 8 to 17 o'clock, and a shadow lasts from its first to its last shaded instant: whole hours only. The
/// limit lies between 2 h, which is the most that passes, and 3 h. So it hangs on minutes which instants a shadow of
/// three hours covers: from 10:59 to 13:59 three of them (2 h), from 10:59 to 14:01 four (3 h), from 11:01 to 14:01
/// three.
TEST(ShippedRules, ZurichCountsHourlyInstants) {
    Rule rule = rule_named("zurich-3h-shadow");
    rule.days.resize(1);
    StudySettings settings = settings_at({radians_from_degrees(47.37), radians_from_degrees(8.54), 0.0});
    settings.timezone = "Europe/Zurich";
    const SunDay day = std::move(days_of(rule, settings).front());
    const Sample up = sample_at({0, 0, 0}, {0, 0, 1});
    // Sunset on 3 November is at 17:06 zone time and sunrise at 7:13: the whole window is day.
    ASSERT_NEAR(day.hours(), 9.0, 1e-3);
    const auto verdict_between = [&](double from_h, double to_h) {
        QuadScene screen;
        add_screen(screen, azimuth_at(day, 3600.0 * (from_h - 8.0)), azimuth_at(day, 3600.0 * (to_h - 8.0)));
        return verdict(rule, 0, screen, up, settings);
    };
    constexpr double kMinute = 1.0 / 60.0;
    EXPECT_EQ(verdict_between(11.0 - kMinute, 14.0 - kMinute), Verdict::pass);
    EXPECT_EQ(verdict_between(11.0 - kMinute, 14.0 + kMinute), Verdict::fail);
    EXPECT_EQ(verdict_between(11.0 + kMinute, 14.0 + kMinute), Verdict::pass);
    EXPECT_EQ(verdict_between(11.0 - kMinute, 13.0 + kMinute), Verdict::pass);
    rule.criteria[0].at_most = 3.0;  // at a limit that a whole number of hours can meet
    EXPECT_EQ(verdict_between(11.0 - kMinute, 14.0 + kMinute), Verdict::borderline);
}

TEST(ShippedRules, CeqrFindsNewShadow) {
    Rule rule = rule_named("nyc-ceqr");
    rule.days = {{3, 21}};
    const StudySettings settings = settings_at({radians_from_degrees(40.71), radians_from_degrees(-74.0), 0.0});
    const SunDay day = std::move(days_of(rule, settings).front());
    const Sample up = sample_at({0, 0, 0}, {0, 0, 1});
    QuadScene before;
    before.ground(50);
    const auto with_screen = [&](double hours) { return hidden_for(day, hours).ground(50); };
    EXPECT_EQ(verdict(rule, 0, QuadScene().ground(50), up, settings, nullptr, &before), Verdict::pass);
    EXPECT_EQ(verdict(rule, 0, with_screen(0.02), up, settings, nullptr, &before), Verdict::borderline);
    EXPECT_EQ(verdict(rule, 0, with_screen(0.1), up, settings, nullptr, &before), Verdict::fail);
}

QuadScene obstruction(double angle_deg) {
    const float top = static_cast<float>(100.0 * std::tan(radians_from_degrees(angle_deg)));
    return QuadScene().quad({-20000, -100, -10}, {20000, -100, -10}, {20000, -100, top}, {-20000, -100, top});
}

TEST(ShippedRules, OibAsksForLightAt45Degrees) {
    const Rule rule = rule_named("oib-rl3-45");
    const Sample wall = sample_at({0, 0, 0}, {0, -1, 0});
    // An endless obstruction of profile angle p stands at atan(tan p cos 30°) in a plane turned by 30°: 45° in the
    // turned plane is p = 49.11°.
    EXPECT_EQ(verdict(rule, 0, obstruction(48.9), wall, settings_at(graz())), Verdict::borderline);
    EXPECT_EQ(verdict(rule, 0, obstruction(46.0), wall, settings_at(graz())), Verdict::pass);
    EXPECT_EQ(verdict(rule, 0, obstruction(52.0), wall, settings_at(graz())), Verdict::fail);
}

/// The obstruction's angle for 27 % by the closed form of tests/study/sky_shares_test.cpp: 25.54°.
TEST(ShippedRules, VscAsksFor27Percent) {
    const Rule rule = rule_named("bre209-vsc");
    const Sample wall = sample_at({0, 0, 0}, {0, -1, 0});
    const StudySettings settings = settings_at(graz());
    EXPECT_EQ(verdict(rule, 0, obstruction(25.54), wall, settings), Verdict::borderline);
    EXPECT_EQ(verdict(rule, 0, obstruction(24.4), wall, settings), Verdict::pass);
    EXPECT_EQ(verdict(rule, 0, obstruction(26.4), wall, settings), Verdict::fail);
    // 0.8 of a former 24.4 % (30°) is 19.5 %: 38.0°. A wall that had little may keep little.
    QuadScene before = obstruction(30.0);
    EXPECT_EQ(verdict(rule, 0, obstruction(35.0), wall, settings, nullptr, &before), Verdict::pass);
    EXPECT_EQ(verdict(rule, 0, obstruction(40.0), wall, settings, nullptr, &before), Verdict::fail);
    QuadScene hardly_any = obstruction(89.0);
    EXPECT_EQ(verdict(rule, 0, hardly_any, wall, settings, nullptr, &hardly_any), Verdict::pass);
}

/// A point on the ground, open to the south-east to south-west by screens; the share of the year's sunshine is summed
/// here from each quarter of an hour's azimuth.
TEST(ShippedRules, ApshAsksFor25And5Percent) {
    const Rule rule = rule_named("bre209-apsh");
    const StudySettings settings = settings_at(graz());
    const YearLight year = cloudless_year(2026, graz(), 0.0);
    const auto open_shares = [&](double half_angle) {
        double all = 0.0, winter = 0.0;
        for (const SunMoment& m : year.moments) {
            const double azimuth = std::atan2(static_cast<double>(m.direction.x), static_cast<double>(m.direction.y));
            if (std::abs(std::remainder(azimuth - kPi, 2.0 * kPi)) > half_angle) continue;
            all += static_cast<double>(m.sunshine_h);
            if (m.is_winter) winter += static_cast<double>(m.sunshine_h);
        }
        return std::pair(100.0 * all / year.sunshine_h, 100.0 * winter / year.sunshine_h);
    };
    const auto angle_for = [&](std::size_t criterion, double share) {
        double low = 0.0, high = kPi;
        while (high - low > 1e-5) {
            const double middle = 0.5 * (low + high);
            const auto [all, winter] = open_shares(middle);
            ((criterion == 0 ? all : winter) < share ? low : high) = middle;
        }
        return low;
    };
    const Sample up = sample_at({0, 0, 0}, {0, 0, 1});
    for (const auto& [criterion, share] : {std::pair<std::size_t, double>{0, 25.0}, {1, 5.0}}) {
        const auto at_share = [&, criterion = criterion](double wanted) {
            QuadScene quads;
            const double angle = angle_for(criterion, wanted);
            add_screen(quads, kPi + angle, 3.0 * kPi - angle);
            return verdict(rule, criterion, quads, up, settings, &year);
        };
        // The lattice's error for a slot is part of a step of 3.75° of hour angle: up to 1 % of the year (0.5 % in
        // winter).
        EXPECT_EQ(at_share(share * 1.15), Verdict::pass) << criterion;
        EXPECT_EQ(at_share(share * 0.85), Verdict::fail) << criterion;
    }
}

/// A free wall sees the sun while it stands before it: the share follows from its azimuth alone, without the lattice's
/// error. Turned so that it is 25 % (5 % in winter) of the year's sunshine it is at the threshold.
TEST(ShippedRules, ApshAtItsThresholds) {
    const Rule rule = rule_named("bre209-apsh");
    const StudySettings settings = settings_at(graz());
    const YearLight year = cloudless_year(2026, graz(), 0.0);
    const auto normal_at = [](double azimuth) {
        return Vec3f(static_cast<float>(std::sin(azimuth)), static_cast<float>(std::cos(azimuth)), 0.0f);
    };
    const auto share_of = [&](std::size_t criterion, double azimuth) {
        double sum = 0.0;
        for (const SunMoment& m : year.moments) {
            if (glm::dot(m.direction, normal_at(azimuth)) > 0.0f && (criterion == 0 || m.is_winter))
                sum += static_cast<double>(m.sunshine_h);
        }
        return 100.0 * sum / year.sunshine_h;
    };
    const Sample at = sample_at({0, 0, 0}, {0, 0, 1});
    for (const auto& [criterion, threshold, step] :
         {std::tuple<std::size_t, double, double>{0, 25.0, 1.0}, {1, 5.0, 1.0}}) {
        const auto verdict_at = [&, criterion = criterion](double share) {
            double low = 0.0, high = kPi;  // from north over east to south
            while (high - low > 1e-6) {
                const double middle = 0.5 * (low + high);
                (share_of(criterion, middle) < share ? low : high) = middle;
            }
            Sample wall = at;
            wall.normal = normal_at(high);
            return verdict(rule, criterion, QuadScene().ground(1, -50), wall, settings, &year);
        };
        EXPECT_EQ(verdict_at(threshold), Verdict::borderline) << criterion;
        EXPECT_EQ(verdict_at(threshold + step), Verdict::pass) << criterion;
        EXPECT_EQ(verdict_at(threshold - step), Verdict::fail) << criterion;
    }
}

/// Twenty equal cells of one polygon, of which so many pass (and passed before) the criterion.
Verdict group_verdict(const Rule& rule, int passing, std::optional<int> passing_before, std::size_t criterion = 0) {
    constexpr int kCells = 20;
    Study study;
    Receiver receiver;
    receiver.id = "a";
    receiver.kind = ReceiverKind::polygon;
    receiver.sample_end = kCells;
    study.receivers.receivers.push_back(receiver);
    CriterionResult result;
    for (int i = 0; i < kCells; ++i) {
        study.receivers.samples.push_back(sample_at({i, 0, 0}, {0, 0, 1}));
        study.receivers.samples.back().area_m2 = 2.0f;
        result.margin.push_back(0.0f);
        result.verdict.push_back(i < passing ? Verdict::pass : Verdict::fail);
        if (passing_before) result.verdict_before.push_back(i < *passing_before ? Verdict::pass : Verdict::fail);
    }
    study.criteria.assign(rule.criteria.size(), result);
    return rolled_up(rule, study, Level::receiver).at(0).criteria[criterion].verdict;
}

TEST(ShippedRules, SharesOfAreaAtAboveAndBelow) {
    const Rule apartments = rule_named("nsw-adg");
    // 70 % of twenty are 14.
    EXPECT_EQ(group_verdict(apartments, 14, {}), Verdict::pass);
    EXPECT_EQ(group_verdict(apartments, 15, {}), Verdict::pass);
    EXPECT_EQ(group_verdict(apartments, 13, {}), Verdict::fail);
    // No more than 15 % without sun: 17 of twenty have some.
    ASSERT_EQ(apartments.criteria[1].id, "some-sun");
    EXPECT_EQ(group_verdict(apartments, 17, {}, 1), Verdict::pass);
    EXPECT_EQ(group_verdict(apartments, 18, {}, 1), Verdict::pass);
    EXPECT_EQ(group_verdict(apartments, 16, {}, 1), Verdict::fail);
    const Rule amenity = rule_named("bre209-amenity");
    EXPECT_EQ(group_verdict(amenity, 10, {}), Verdict::pass);
    EXPECT_EQ(group_verdict(amenity, 9, {}), Verdict::fail);
    // 0.8 of the area that had it: 8 of 10 are enough, 7 of 10 are not; and half is enough, whatever was before.
    EXPECT_EQ(group_verdict(amenity, 8, 10), Verdict::pass);
    EXPECT_EQ(group_verdict(amenity, 7, 10), Verdict::fail);
    EXPECT_EQ(group_verdict(amenity, 10, 20), Verdict::pass);
}

TEST(ShippedRules, IrradiationHasNoThreshold) {
    EXPECT_TRUE(rule_named("irradiation").criteria.empty());
    EXPECT_TRUE(rule_named("irradiation").needs_weather);
}

TEST(ShippedRules, AllReadAndSayWhatToCheck) {
    const std::vector<std::string> names = shipped_rules(kRules);
    EXPECT_EQ(names.size(), 21u);
    for (const std::string& name : names) {
        const Rule rule = rule_named(name);
        EXPECT_EQ(rule.id, name);
        EXPECT_FALSE(rule.to_check.empty()) << name;
        EXPECT_FALSE(rule.source.empty()) << name;
        ASSERT_TRUE(rule.german) << name;  // complete, or it would not have been read
        EXPECT_NE(rule.german->title, "") << name;
    }
    EXPECT_TRUE(rule_named("shadow-study").criteria.empty());
    EXPECT_THROW(rule_file_of("en17037", kRules), InputError);
}

TEST(RuleFiles, FaultsAreNamedWithTheirPlace) {
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "skybake_rule_fault.json";
    const auto message_of = [&](const std::string& text) -> std::string {
        std::ofstream(file) << text;
        try {
            io::read_rule(file);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    const std::string head =
        R"({"skybake_rule": 1, "id": "a", "version": "1", "title": "t", "source": "s", "source_date": "d", )";
    const std::string kinds = R"("receivers": {"kinds": ["facade"]}, )";
    using testing::HasSubstr;
    EXPECT_THAT(message_of(head + R"("to_check": ["a", "b"], "de": {"title": "t", "to_check": ["a"]}, )" + kinds +
                           R"("metrics": ["sky_view_factor"]})"),
                HasSubstr("#/de 'to_check' has 1 texts, and the rule 2"));
    EXPECT_THAT(message_of("{"), HasSubstr("is no JSON"));
    EXPECT_THAT(message_of(R"({"skybake_rule": 2})"), HasSubstr("another format"));
    EXPECT_THAT(message_of(head + kinds + R"("metrics": ["sun_hour"]})"),
                HasSubstr("'metrics' is 'sun_hour', not one of"));
    EXPECT_THAT(message_of(head + kinds + R"("metrics": ["sun_hours"]})"), HasSubstr("without 'sun'"));
    EXPECT_THAT(message_of(head + kinds + R"("sun": {"days": ["21-03-1"]}})"), HasSubstr("#/sun 'days' has '21-03-1'"));
    EXPECT_THAT(message_of(head + kinds + R"("criterias": []})"), HasSubstr("did you mean 'criteria'?"));
    EXPECT_THAT(message_of(head + R"("receivers": {"kinds": ["wall"]}})"), HasSubstr("not one of ground"));
    EXPECT_THAT(message_of(head + kinds +
                           R"("criteria": [{"id": "c", "metric": "sky_view_factor", "at_least": 1, "at_most": 2}]})"),
                HasSubstr("#/criteria/0 has both"));
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace skybake
