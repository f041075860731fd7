#include "api/study_city.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "api/study_pictures.h"
#include "base/error.h"
#include "base/nearest_word.h"

namespace skybake {

StudyResult study_city(const StudyRequest& request, Progress& progress) {
    StudyResult result;
    PreparedStudy prepared = prepare_study(request, progress);
    result.findings = prepared.findings;
    result.city = std::move(prepared.city_model);
    result.study = run_study(request.rule, std::move(prepared.receivers), std::move(prepared.days), prepared.city(),
                             prepared.former(), prepared.settings, progress);
    result.groups = rolled_up(request.rule, result.study);
    if (request.wants_pictures) result.pictures = study_pictures(request.rule, prepared, result.study, progress);

    io::StudyFacts& facts = result.facts;
    facts.embree_isa = prepared.after->rays.isa();
    facts.crs = prepared.crs;
    facts.settings = prepared.settings;
    facts.settings.year_light = nullptr;
    facts.receivers = prepared.receiver_options;
    facts.period = request.period;
    if (prepared.year) facts.weather = request.weather ? request.weather->name() : "none: every moment with the sun up";
    for (std::size_t k = 0; k < prepared.settings.instants.size(); ++k)
        facts.instants.push_back(
            fmt::format("{}: {}", prepared.settings.instants[k].label, to_text(sky_at(*request.instants, k))));
    facts.plan = prepared.plan;
    facts.removed = prepared.removed;
    facts.has_before = prepared.former().has_value();
    return result;
}

std::vector<std::string> shipped_rules(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::filesystem::path rule_file_of(const std::string& name, const std::filesystem::path& folder) {
    if (const std::filesystem::path shipped = folder / (name + ".json"); std::filesystem::exists(shipped))
        return shipped;
    if (std::filesystem::exists(name)) return name;
    const std::vector<std::string> names = shipped_rules(folder);
    throw InputError(
        fmt::format("--rule '{}' is neither a file nor a shipped rule; did you mean '{}'? Shipped are: {}.", name,
                    nearest_word(name, names), fmt::join(names, ", ")));
}

}  // namespace skybake
