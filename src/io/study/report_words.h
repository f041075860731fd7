// The words of a study's report in the reader's language, and its numbers as that language writes them.
#pragma once

#include <string>
#include <string_view>

#include "study/rule.h"
#include "study/study.h"

namespace skybake::io {

enum class Language { english, german };

class Words {
  public:
    explicit Words(Language language) : language_(language) {}
    /// One of two texts.
    std::string operator()(std::string_view english, std::string_view german) const {
        return std::string(language_ == Language::english ? english : german);
    }
    const char* code() const { return language_ == Language::english ? "en" : "de"; }

    /// With so many decimals, a true minus and the language's decimal sign; "–" for what is not finite.
    std::string number(double value, int decimals) const;
    /// With its sign: "+1.5", "−0.2", "0".
    std::string change(double value, int decimals) const;
    /// In thousands that are set apart: "12 345".
    std::string count(std::uint64_t value) const;
    std::string percent(double share) const { return number(100.0 * share, 1) + " %"; }

    std::string metric(Metric metric) const;
    std::string unit(Metric metric) const;  // "h", "%", "kWh/m²", …; empty for shares
    std::string kind(ReceiverKind kind) const;
    std::string role(std::string_view role) const;  // of StudyInput
    std::string verdict(Verdict verdict) const;
    std::string day(CalendarDay day) const;                              // "21 March"
    std::string column(const Study& study, const Column& column) const;  // metric, day and state, with the unit

  private:
    Language language_;
};

}  // namespace skybake::io
