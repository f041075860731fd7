#include "base/finding.h"

#include <fmt/format.h>

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
    finding.count = 1;
    if (entries.kept.size() < kKeptPerCode) entries.kept.push_back(std::move(finding));
}

void FindingLog::merge(const FindingLog& other) {
    for (const auto& [code, theirs] : other.by_code_) {
        Entries& entries = by_code_[code];
        entries.count += theirs.count;
        for (const Finding& finding : theirs.kept) {
            if (entries.kept.size() < kKeptPerCode) entries.kept.push_back(finding);
        }
    }
}

std::vector<Finding> FindingLog::list() const {
    std::vector<Finding> all;
    for (const auto& [code, entries] : by_code_) {
        const std::size_t first = all.size();
        all.insert(all.end(), entries.kept.begin(), entries.kept.end());
        if (first < all.size()) all[first].count = entries.count - (entries.kept.size() - 1);
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
        if (!entries.kept.empty() && entries.kept.front().severity == severity) sum += entries.count;
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
