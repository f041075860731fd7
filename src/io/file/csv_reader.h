// Comma separated values, record by record.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace skybake::io {

/// Walks through the text record by record; a quoted field may hold commas, doubled quotes and line ends (RFC 4180).
/// Text and name must outlive it.
class CsvReader {
  public:
    CsvReader(std::string_view text, const std::string& name);

    /// False at the end. Lines that are empty are passed over. Throws InputError for a quote without end.
    bool next(std::vector<std::string>& fields);

    /// Throws InputError with the file and the record's line.
    [[noreturn]] void fail(const std::string& what) const;

  private:
    void read_record(std::vector<std::string>& fields);
    std::string read_field();

    std::string_view text_;
    const std::string& name_;
    std::size_t at_ = 0;
    std::uint64_t line_ = 1;
    std::uint64_t record_line_ = 1;
};

}  // namespace skybake::io
