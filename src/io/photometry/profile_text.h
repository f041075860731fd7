// Numbers from the lines of a photometric file: for its readers alone.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "light/light_profile.h"

namespace skybake::io {

class ProfileText {
  public:
    /// `name` is the file's, for messages.
    ProfileText(std::string name, std::string_view text);

    bool at_end() const { return line_ >= lines_.size(); }
    /// The next line without blanks about it; moves on. Throws at the end.
    std::string_view line(const char* what);
    /// The next line as one number; commas are points.
    double number_on_line(const char* what, double lowest, double highest);
    /// The next word, of this line or a later one, as a number: blanks and commas part words.
    double number(const char* what, double lowest, double highest);

    /// Throws InputError with file and the line read last.
    [[noreturn]] void fail(const std::string& what) const;

  private:
    double parsed(std::string_view word, const char* what, double lowest, double highest) const;

    std::string name_;
    std::vector<std::string_view> lines_;
    std::size_t line_ = 0;   // the next
    std::string_view rest_;  // of the line that words are taken from
};

/// Angles of a table, degrees: `count` of them, ascending.
std::vector<double> ascending_angles(ProfileText& text, std::size_t count, const char* what, bool is_one_a_line);

/// The profile of half or quarter planes: `c_deg` within 0…360, the planes measured. Mirrors and turns them as the
/// range says: one plane stands for all; 0…90 for four quarters, 0…180 and 90…270 for two halves. Throws through
/// `text` where the range is none of these or the light is 0.
LightProfile completed_profile(const ProfileText& text, const std::vector<double>& c_deg,
                               const std::vector<double>& gamma_deg, const std::vector<double>& candela);

LightProfile parse_ies(ProfileText& text);
LightProfile parse_eulumdat(ProfileText& text);

}  // namespace skybake::io
