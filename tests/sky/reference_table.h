// Reads the reference tables: CSV with a header line, no quotes.
#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace skybake {

class ReferenceRow {
  public:
    explicit ReferenceRow(std::map<std::string, std::string> fields) : fields_(std::move(fields)) {}
    const std::string& text(const std::string& column) const { return fields_.at(column); }
    bool has(const std::string& column) const { return !fields_.at(column).empty(); }
    double number(const std::string& column) const { return std::stod(fields_.at(column)); }

  private:
    std::map<std::string, std::string> fields_;
};

inline std::vector<ReferenceRow> read_reference(const std::filesystem::path& path) {
    const auto split = [](const std::string& line) {
        std::vector<std::string> fields;
        std::size_t begin = 0;
        for (std::size_t comma; (comma = line.find(',', begin)) != std::string::npos; begin = comma + 1) {
            fields.push_back(line.substr(begin, comma - begin));
        }
        fields.push_back(line.substr(begin));
        return fields;
    };
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> columns = split(line);
    std::vector<ReferenceRow> rows;
    while (std::getline(file, line)) {
        if (line.empty()) continue;
        const std::vector<std::string> fields = split(line);
        std::map<std::string, std::string> row;
        for (std::size_t i = 0; i < columns.size(); ++i) row[columns[i]] = i < fields.size() ? fields[i] : "";
        rows.emplace_back(std::move(row));
    }
    return rows;
}

}  // namespace skybake
