#include "io/study/check_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <unordered_map>

#include "io/file/csv_reader.h"
#include "io/file/replace_file.h"

namespace skybake::io {
namespace {

/// A table with a head line.
class Table {
  public:
    explicit Table(const std::filesystem::path& path)
        : name_(path.string()), bytes_(read_file(path)), text_(bytes_.begin(), bytes_.end()), csv_(text_, name_) {
        std::vector<std::string> head;
        if (!csv_.next(head)) csv_.fail("is empty.");
        for (std::size_t c = 0; c < head.size(); ++c) column_.emplace(head[c], c);
        width_ = head.size();
    }
    bool next() {
        if (!csv_.next(fields_)) return false;
        if (fields_.size() != width_) csv_.fail(fmt::format("has {} fields, and the head {}.", fields_.size(), width_));
        return true;
    }
    const std::string& text(const std::string& column) const {
        const auto found = column_.find(column);
        if (found == column_.end()) csv_.fail(fmt::format("there is no column '{}'.", column));
        return fields_[found->second];
    }
    double number(const std::string& column) const {
        const std::string& field = text(column);
        double value = 0.0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc() || end != field.data() + field.size())
            csv_.fail(fmt::format("'{}' in column {} is no number.", field, column));
        return value;
    }
    [[noreturn]] void fail(const std::string& what) const { csv_.fail(what); }

  private:
    std::string name_;
    std::vector<std::uint8_t> bytes_;
    std::string text_;
    CsvReader csv_;
    std::unordered_map<std::string, std::size_t> column_;
    std::size_t width_ = 0;
    std::vector<std::string> fields_;
};

std::optional<ReceiverKind> kind_of(const std::string& name) {
    for (const ReceiverKind kind : {ReceiverKind::ground, ReceiverKind::polygon, ReceiverKind::roof,
                                    ReceiverKind::facade, ReceiverKind::window, ReceiverKind::point}) {
        if (name == name_of(kind)) return kind;
    }
    return std::nullopt;
}

/// Adds the line's cell to the receivers; lines of one receiver stand together.
void add_cell(ReceiverSet& set, const Table& table) {
    const std::optional<ReceiverKind> kind = kind_of(table.text("kind"));
    if (!kind) table.fail(fmt::format("'{}' is no kind of receiver.", table.text("kind")));
    const std::string& id = table.text("receiver");
    if (set.receivers.empty() || set.receivers.back().id != id || set.receivers.back().kind != *kind) {
        Receiver receiver;
        receiver.id = id;
        receiver.kind = *kind;
        receiver.building_id = table.text("building");
        receiver.object_id = table.text("object");
        if (!table.text("surface").empty()) receiver.surface = static_cast<std::uint32_t>(table.number("surface"));
        if (!table.text("storey").empty()) receiver.storey = static_cast<int>(table.number("storey"));
        receiver.sample_begin = static_cast<std::uint32_t>(set.samples.size());
        set.receivers.push_back(std::move(receiver));
    }
    Sample sample;
    sample.area_m2 = static_cast<float>(table.number("area_m2"));
    sample.receiver = static_cast<std::uint32_t>(set.receivers.size() - 1);
    set.samples.push_back(sample);
    set.receivers.back().sample_end = static_cast<std::uint32_t>(set.samples.size());
}

/// Six digits may put a value on the other side of the threshold.
bool is_doubtful(const Criterion& criterion, double value, double margin) {
    return std::abs(std::abs(margin) - criterion.tolerance) <= kTableDigits * std::max(std::abs(value), 1e-3);
}

}  // namespace

TableStudy read_cells_csv(const std::filesystem::path& path, const Rule& rule, const std::vector<Column>& columns) {
    TableStudy result;
    Study& study = result.study;
    study.columns = columns;
    for (Column& column : study.columns) column.values.clear();
    std::vector<std::vector<std::string>> told(rule.criteria.size());
    Table table(path);
    while (table.next()) {
        add_cell(study.receivers, table);
        for (Column& column : study.columns) column.values.push_back(static_cast<float>(table.number(column.name)));
        for (std::size_t c = 0; c < rule.criteria.size(); ++c)
            told[c].push_back(table.text(rule.criteria[c].id + "_verdict"));
    }
    study.criteria = judged(rule, study);
    for (std::size_t c = 0; c < rule.criteria.size(); ++c) {
        CriterionResult& criterion = study.criteria[c];
        for (std::size_t i = 0; i < told[c].size(); ++i) {
            if (told[c][i] != name_of(Verdict::none)) ++result.verdicts;
            if (told[c][i] == name_of(criterion.verdict[i])) continue;
            const Verdict known[] = {Verdict::pass, Verdict::borderline, Verdict::fail};
            const auto verdict =
                std::find_if(std::begin(known), std::end(known), [&](Verdict v) { return told[c][i] == name_of(v); });
            if (verdict != std::end(known) && is_doubtful(rule.criteria[c], static_cast<double>(criterion.value[i]),
                                                          static_cast<double>(criterion.margin[i]))) {
                criterion.verdict[i] = *verdict;
                continue;
            }
            result.other_verdicts.push_back(
                fmt::format("cell {} of {}: {} is '{}' in cells.csv, and '{}' by the rule", i,
                            study.receivers.receivers[study.receivers.samples[i].receiver].id, rule.criteria[c].id,
                            told[c][i], name_of(criterion.verdict[i])));
        }
    }
    return result;
}

std::vector<std::string> check_groups_csv(const std::filesystem::path& path, const Rule& rule, const Study& study,
                                          const std::vector<Group>& groups, std::uint64_t& rows) {
    std::vector<std::string> differences;
    Table table(path);
    std::size_t next = 0;
    while (table.next()) {
        ++rows;
        if (next == groups.size()) {
            ++next;
            break;
        }
        const Group& group = groups[next++];
        const std::string name = fmt::format("{} {}", name_of(group.level), group.id);
        if (table.text("level") != name_of(group.level) || table.text("id") != group.id) {
            differences.push_back(
                fmt::format("groups.csv tells of {} {} where {} belongs", table.text("level"), table.text("id"), name));
            return differences;
        }
        const auto number = [&](const std::string& column, double value) {
            const double told = table.number(column);
            if (std::abs(told - value) > kTableDigits * std::max(std::abs(value), 0.1))
                differences.push_back(
                    fmt::format("{}: {} is {:.6g} in groups.csv, and {:.6g} by its cells", name, column, told, value));
        };
        const auto word = [&](const std::string& column, Verdict verdict) {
            if (table.text(column) != name_of(verdict))
                differences.push_back(fmt::format("{}: {} is '{}' in groups.csv, and '{}' by its cells", name, column,
                                                  table.text(column), name_of(verdict)));
        };
        number("samples", static_cast<double>(group.samples));
        number("area_m2", group.area_m2);
        word("verdict", group.verdict);
        for (std::size_t c = 0; c < study.columns.size(); ++c) {
            number(study.columns[c].name + "_mean", group.columns[c].mean);
            number(study.columns[c].name + "_least", group.columns[c].least);
            number(study.columns[c].name + "_greatest", group.columns[c].greatest);
        }
        for (std::size_t c = 0; c < rule.criteria.size(); ++c) {
            const GroupCriterion& criterion = group.criteria[c];
            number(rule.criteria[c].id + "_area_pass", criterion.area_pass);
            number(rule.criteria[c].id + "_area_borderline", criterion.area_borderline);
            number(rule.criteria[c].id + "_area_fail", criterion.area_fail);
            word(rule.criteria[c].id + "_verdict", criterion.verdict);
        }
    }
    if (next != groups.size())
        differences.push_back(
            fmt::format("groups.csv has {} lines, and the cells make {} groups", rows, groups.size()));
    return differences;
}

}  // namespace skybake::io
