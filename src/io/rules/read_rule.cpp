#include "io/rules/read_rule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/nearest_word.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

using nlohmann::json;

/// An object of the file, with its place for messages; every key must be asked for, and none may be left over.
class Node {
  public:
    Node(const json& object, std::string file, std::string place)
        : object_(object), file_(std::move(file)), place_(std::move(place)) {
        if (!object.is_object()) fail("must be an object {…}.");
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {} {}", file_, place_, what));
    }
    void allow(const std::vector<std::string>& known) const {
        for (const auto& [key, value] : object_.items()) {
            if (std::find(known.begin(), known.end(), key) == known.end())
                fail(fmt::format("has the unknown key '{}'; did you mean '{}'?", key, nearest_word(key, known)));
        }
    }
    bool has(const char* key) const { return object_.contains(key); }
    const json& at(const char* key) const {
        if (!has(key)) fail(fmt::format("lacks '{}'.", key));
        return object_[key];
    }
    Node child(const char* key) const { return {at(key), file_, fmt::format("{}/{}", place_, key)}; }
    Node item(const json& value, const char* key, std::size_t i) const {
        return {value, file_, fmt::format("{}/{}/{}", place_, key, i)};
    }

    std::string text(const char* key) const {
        if (!at(key).is_string()) fail(fmt::format("'{}' must be text.", key));
        return at(key).get<std::string>();
    }
    std::string text_or(const char* key, std::string fallback) const { return has(key) ? text(key) : fallback; }
    double number(const char* key, double low, double high) const {
        if (!at(key).is_number()) fail(fmt::format("'{}' must be a number.", key));
        const double value = at(key).get<double>();
        if (!(value >= low && value <= high)) fail(fmt::format("'{}' {} is not in {}…{}.", key, value, low, high));
        return value;
    }
    double number_or(const char* key, double fallback, double low, double high) const {
        return has(key) ? number(key, low, high) : fallback;
    }
    bool flag_or(const char* key, bool fallback) const {
        if (!has(key)) return fallback;
        if (!at(key).is_boolean()) fail(fmt::format("'{}' must be true or false.", key));
        return at(key).get<bool>();
    }
    std::vector<std::string> texts(const char* key) const {
        std::vector<std::string> list;
        if (!has(key)) return list;
        if (!at(key).is_array()) fail(fmt::format("'{}' must be a list of texts.", key));
        for (const json& entry : at(key)) {
            if (!entry.is_string()) fail(fmt::format("'{}' must be a list of texts.", key));
            list.push_back(entry.get<std::string>());
        }
        return list;
    }
    /// The value of a key as one of the words; `fallback` without the key.
    template <typename T>
    T word_or(const char* key, T fallback, const std::vector<std::pair<std::string, T>>& words) const {
        if (!has(key)) return fallback;
        return word(text(key), key, words);
    }
    template <typename T>
    T word(const std::string& typed, const char* key, const std::vector<std::pair<std::string, T>>& words) const {
        std::vector<std::string> known;
        for (const auto& [name, value] : words) {
            if (name == typed) return value;
            known.push_back(name);
        }
        fail(fmt::format("'{}' is '{}', not one of {}.", key, typed, fmt::join(known, ", ")));
    }

  private:
    const json& object_;
    std::string file_;
    std::string place_;
};

std::vector<ReceiverKind> kinds_of(const Node& node, const char* key) {
    std::vector<std::pair<std::string, ReceiverKind>> words;
    for (const ReceiverKind kind : {ReceiverKind::ground, ReceiverKind::polygon, ReceiverKind::roof,
                                    ReceiverKind::facade, ReceiverKind::window, ReceiverKind::point})
        words.emplace_back(name_of(kind), kind);
    std::vector<ReceiverKind> kinds;
    for (const std::string& name : node.texts(key)) kinds.push_back(node.word(name, key, words));
    return kinds;
}

Metric metric_named(const Node& node, const char* key, const std::string& name) {
    std::vector<std::pair<std::string, Metric>> words;
    for (int m = 0; m < kMetricCount; ++m) words.emplace_back(name_of(static_cast<Metric>(m)), static_cast<Metric>(m));
    return node.word(name, key, words);
}

CalendarDay day_of(const Node& node, const std::string& text) {
    CalendarDay day;
    const bool has_form = text.size() == 5 && text[2] == '-' && std::all_of(text.begin(), text.end(), [](char c) {
                              return c == '-' || (c >= '0' && c <= '9');
                          });
    if (has_form) {
        day.month = std::stoi(text.substr(0, 2));
        day.day = std::stoi(text.substr(3));
    }
    if (!has_form || day.month < 1 || day.month > 12 || day.day < 1 || day.day > 31)
        node.fail(fmt::format("'days' has '{}', which is no day; write MM-DD, such as 03-21.", text));
    return day;
}

void read_sun(const Node& sun, Rule& rule) {
    sun.allow({"days", "window", "min_elevation_deg", "min_incidence_deg", "min_run_min", "step_min", "between_samples",
               "occluders"});
    for (const std::string& text : sun.texts("days")) rule.days.push_back(day_of(sun, text));
    if (rule.days.empty()) sun.fail("lacks 'days': at least one, such as [\"03-21\"].");
    if (sun.has("window")) {
        using Clock = SunWindow::Clock;
        const Node window = sun.child("window");
        window.allow({"clock", "start_h", "end_h"});
        rule.window.clock = window.word_or<Clock>("clock", Clock::daylight,
                                                  {{"daylight", Clock::daylight},
                                                   {"civil", Clock::civil},
                                                   {"standard", Clock::standard},
                                                   {"solar", Clock::solar},
                                                   {"after_sunrise", Clock::after_sunrise}});
        if (rule.window.clock != Clock::daylight) {
            rule.window.start_h = window.number("start_h", 0.0, 24.0);
            rule.window.end_h = window.number("end_h", 0.0, 24.0);
        }
    }
    rule.min_elevation_deg = sun.number_or("min_elevation_deg", 0.0, 0.0, 60.0);
    rule.min_incidence_deg = sun.number_or("min_incidence_deg", 0.0, 0.0, 60.0);
    rule.min_run_min = sun.number_or("min_run_min", 0.0, 0.0, 600.0);
    const auto between = sun.word_or<BetweenSamples>("between_samples", BetweenSamples::nearest,
                                                     {{"nearest", BetweenSamples::nearest},
                                                      {"shadow_needs_both", BetweenSamples::shadow_needs_both},
                                                      {"sun_needs_both", BetweenSamples::sun_needs_both}});
    if (sun.has("step_min")) rule.sampled = SampledConstruction{60.0 * sun.number("step_min", 0.1, 180.0), between};
    rule.occluders =
        sun.word_or<Occluders>("occluders", Occluders::all, {{"all", Occluders::all}, {"plan", Occluders::plan}});
}

Criterion criterion_of(const Node& node) {
    node.allow({"id", "text", "metric", "at_least", "at_most", "or_share_of_before", "tolerance", "over_days",
                "area_share", "or_share_of_area_before", "required", "kinds"});
    Criterion criterion;
    criterion.id = node.text("id");
    criterion.text = node.text_or("text", "");
    criterion.metric = metric_named(node, "metric", node.text("metric"));
    if (node.has("at_least")) criterion.at_least = node.number("at_least", 0.0, 1e6);
    if (node.has("at_most")) criterion.at_most = node.number("at_most", 0.0, 1e6);
    if (criterion.at_least && criterion.at_most) node.fail("has both 'at_least' and 'at_most': write two criteria.");
    if (node.has("or_share_of_before")) criterion.or_share_of_before = node.number("or_share_of_before", 0.0, 1.0);
    criterion.tolerance = node.number_or("tolerance", 0.0, 0.0, 1e6);
    criterion.over_days = node.word_or<OverDays>(
        "over_days", OverDays::each, {{"each", OverDays::each}, {"any", OverDays::any}, {"mean", OverDays::mean}});
    criterion.area_share = node.number_or("area_share", 1.0, 0.0, 1.0);
    if (node.has("or_share_of_area_before"))
        criterion.or_share_of_area_before = node.number("or_share_of_area_before", 0.0, 1.0);
    criterion.is_required = node.flag_or("required", true);
    criterion.kinds = kinds_of(node, "kinds");
    return criterion;
}

/// The German texts, which must stand beside all the English ones.
RuleTexts german_texts(const Node& de, const Rule& rule) {
    de.allow({"title", "confirmed", "to_check", "criteria"});
    RuleTexts texts{de.text("title"), de.texts("confirmed"), de.texts("to_check"), de.texts("criteria")};
    const auto check = [&](const char* key, std::size_t found, std::size_t wanted) {
        if (found != wanted)
            de.fail(fmt::format("'{}' has {} texts, and the rule {}: one for each.", key, found, wanted));
    };
    check("confirmed", texts.confirmed.size(), rule.confirmed.size());
    check("to_check", texts.to_check.size(), rule.to_check.size());
    check("criteria", texts.criteria.size(), rule.criteria.size());
    return texts;
}

}  // namespace

Rule read_rule(const std::filesystem::path& path) {
    const std::vector<std::uint8_t> bytes = read_file(path, 1u << 20);
    json document;
    try {
        document = json::parse(bytes.begin(), bytes.end());
    } catch (const json::parse_error& error) {
        throw InputError(fmt::format("{}: is no JSON: {}", path.string(), error.what()));
    }
    const Node root(document, path.string(), "#");
    root.allow({"$schema", "skybake_rule", "id", "version", "title", "source", "source_date", "confirmed", "to_check",
                "de", "receivers", "sun", "needs_before", "needs_weather", "swivel_deg", "metrics", "criteria"});
    if (root.number("skybake_rule", 0, 1e6) != kRuleFormat)
        root.fail(fmt::format("is of another format; this version reads \"skybake_rule\": {}.", kRuleFormat));
    Rule rule;
    rule.id = root.text("id");
    rule.version = root.text("version");
    rule.title = root.text("title");
    rule.source = root.text("source");
    rule.source_date = root.text("source_date");
    rule.confirmed = root.texts("confirmed");
    rule.to_check = root.texts("to_check");
    const Node receivers = root.child("receivers");
    receivers.allow({"kinds", "height_m"});
    rule.kinds = kinds_of(receivers, "kinds");
    if (rule.kinds.empty()) receivers.fail("'kinds' names no receiver.");
    rule.height_m = receivers.number_or("height_m", 0.0, 0.0, 100.0);
    if (root.has("sun")) read_sun(root.child("sun"), rule);
    rule.needs_before = root.flag_or("needs_before", false);
    rule.needs_weather = root.flag_or("needs_weather", false);
    rule.swivel_deg = root.number_or("swivel_deg", 30.0, 0.0, 90.0);
    for (const std::string& name : root.texts("metrics")) rule.metrics.push_back(metric_named(root, "metrics", name));
    if (root.has("criteria")) {
        if (!root.at("criteria").is_array()) root.fail("'criteria' must be a list.");
        std::size_t i = 0;
        for (const json& entry : root.at("criteria"))
            rule.criteria.push_back(criterion_of(root.item(entry, "criteria", i++)));
    }
    if (root.has("de")) rule.german = german_texts(root.child("de"), rule);
    const std::vector<Metric> metrics = rule.all_metrics();
    if (metrics.empty()) root.fail("has neither 'criteria' nor 'metrics': nothing to compute.");
    if (rule.days.empty() && std::any_of(metrics.begin(), metrics.end(), is_of_days))
        root.fail("asks for sun or shadow without 'sun': {'days': …}.");
    return rule;
}

}  // namespace skybake::io
