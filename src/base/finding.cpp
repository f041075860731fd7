#include "base/finding.h"

#include <fmt/format.h>

#include <iterator>

namespace skybake {

const char* name_of(Severity severity) {
    switch (severity) {
        case Severity::info:
            return "info";
        case Severity::warning:
            return "warning";
        case Severity::error:
            return "error";
    }
    return "error";
}

void FindingLog::add(Finding finding) {
    Entries& entries = by_code_[finding.code];
    entries.count += finding.count;
    std::pair<std::string, std::string> key(finding.where, finding.what);
    const auto found = entries.kept.find(key);
    if (found != entries.kept.end()) {
        found->second.count += finding.count;
        return;
    }
    // One that falls out never comes back: so many smaller ones are there for good.
    entries.kept.emplace(std::move(key), std::move(finding));
    if (entries.kept.size() > kKeptPerCode) entries.kept.erase(std::prev(entries.kept.end()));
}

void FindingLog::merge(const FindingLog& other) {
    for (const auto& [code, theirs] : other.by_code_) {
        std::uint64_t kept = 0;
        for (const auto& [key, finding] : theirs.kept) {
            kept += finding.count;
            add(finding);
        }
        by_code_[code].count += theirs.count - kept;
    }
}

std::vector<Finding> FindingLog::list() const {
    std::vector<Finding> all;
    for (const auto& [code, entries] : by_code_) {
        const std::size_t first = all.size();
        std::uint64_t kept = 0;
        for (const auto& [key, finding] : entries.kept) {
            all.push_back(finding);
            kept += finding.count;
        }
        if (first < all.size()) all[first].count += entries.count - kept;
    }
    return all;
}

std::uint64_t FindingLog::count(const std::string& code) const {
    const auto found = by_code_.find(code);
    return found == by_code_.end() ? 0 : found->second.count;
}

std::uint64_t FindingLog::count(Severity severity) const {
    std::uint64_t sum = 0;
    for (const auto& [code, entries] : by_code_) {
        if (!entries.kept.empty() && entries.kept.begin()->second.severity == severity) sum += entries.count;
    }
    return sum;
}

std::string to_text(const Finding& finding) {
    const std::string number = finding.count > 1 ? fmt::format(" ({} of these)", finding.count) : "";
    const std::string remedy = finding.remedy.empty() ? "" : " " + finding.remedy;
    return fmt::format("{} {}{}: {}: {}{}", finding.code, name_of(finding.severity), number, finding.where,
                       finding.what, remedy);
}

}  // namespace skybake
