// What is wrong with a part of the input: that part is repaired or left out, the rest goes on, and the report lists
// all.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace skybake {

enum class Severity { info, warning, error };

/// "info", "warning" or "error".
const char* name_of(Severity severity);

struct Finding {
    std::string code;  // stable, "SB" and three digits: city/finding_codes.h
    Severity severity = Severity::warning;
    std::string where;   // file and place in it: "delft.city.json: #/CityObjects/b-17/geometry/0"
    std::string what;    // the fault, and what was done about it
    std::string remedy;  // what the user can do
    std::uint64_t count = 1;
};

/// Collects findings: a few of each code whole, of all others the number, so that a city with a million faults stays
/// readable. What it lists does not hang on the order in which findings came. Not thread-safe: one log a task, merged.
class FindingLog {
  public:
    static constexpr std::size_t kKeptPerCode = 20;

    void add(Finding finding);
    void merge(const FindingLog& other);

    /// Findings in order of code, place and fault, equal ones as one with their count; of each code the first
    /// kKeptPerCode. The first entry of a code carries, in `count`, those that are not listed too; so the counts of a
    /// code add up to their number.
    std::vector<Finding> list() const;
    /// How many findings there are of the code.
    std::uint64_t count(const std::string& code) const;
    /// How many there are of the severity, over all codes.
    std::uint64_t count(Severity severity) const;
    bool empty() const { return by_code_.empty(); }

  private:
    struct Entries {
        std::map<std::pair<std::string, std::string>, Finding> kept;  // by place and fault
        std::uint64_t count = 0;
    };
    std::map<std::string, Entries> by_code_;
};

/// "SB203 warning: WHERE: WHAT REMEDY"; with a count above 1, "(N of these)" behind the code.
std::string to_text(const Finding& finding);

}  // namespace skybake
