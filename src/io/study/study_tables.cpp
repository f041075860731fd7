#include "io/study/study_tables.h"

#include <fmt/format.h>

#include <iterator>

#include "base/vec.h"
#include "io/file/csv_field.h"
#include "io/file/replace_file.h"
#include "io/gdal/write_maps.h"

namespace skybake::io {
namespace {

/// Text that goes to the file piece by piece, so that a million lines need no memory.
class Lines {
  public:
    explicit Lines(const std::filesystem::path& path) : file_(path) {}
    template <typename... T>
    void put(fmt::format_string<T...> format, T&&... values) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
        if (text_.size() > (1u << 20)) flush();
    }
    void commit() {
        flush();
        file_.commit();
    }

  private:
    void flush() {
        file_.write(text_);
        text_.clear();
    }
    FileReplacement file_;
    std::string text_;
};

}  // namespace

void write_cells_csv(const std::filesystem::path& path, const Rule& rule, const Study& study) {
    Lines lines(path);
    lines.put("receiver,kind,building,object,surface,storey,x,y,z,nx,ny,nz,area_m2");
    for (const Column& column : study.columns) lines.put(",{}", column.name);
    for (const Criterion& c : rule.criteria) lines.put(",{0}_value,{0}_margin,{0}_verdict", c.id);
    lines.put("\n");
    for (std::size_t i = 0; i < study.receivers.samples.size(); ++i) {
        const Sample& s = study.receivers.samples[i];
        const Receiver& r = study.receivers.receivers[s.receiver];
        lines.put("{},{},{},{},{},{},{:.3f},{:.3f},{:.3f},{:.6g},{:.6g},{:.6g},{:.6g}", csv_field(r.id),
                  name_of(r.kind), csv_field(r.building_id), csv_field(r.object_id),
                  r.surface ? std::to_string(*r.surface) : "", r.storey ? std::to_string(*r.storey) : "", s.position.x,
                  s.position.y, s.position.z, s.normal.x, s.normal.y, s.normal.z, s.area_m2);
        for (const Column& column : study.columns) lines.put(",{:.6g}", column.values[i]);
        for (const CriterionResult& c : study.criteria)
            lines.put(",{:.6g},{:.6g},{}", c.value[i], c.margin[i], name_of(c.verdict[i]));
        lines.put("\n");
    }
    lines.commit();
}

void write_groups_csv(const std::filesystem::path& path, const Rule& rule, const Study& study,
                      const std::vector<Group>& groups) {
    Lines lines(path);
    lines.put("level,id,kind,building,samples,area_m2,verdict");
    for (const Column& column : study.columns) lines.put(",{0}_mean,{0}_least,{0}_greatest", column.name);
    for (const Criterion& c : rule.criteria)
        lines.put(",{0}_area_pass,{0}_area_borderline,{0}_area_fail,{0}_verdict", c.id);
    lines.put("\n");
    for (const Group& group : groups) {
        lines.put("{},{},{},{},{},{:.6g},{}", name_of(group.level), csv_field(group.id), name_of(group.kind),
                  csv_field(group.building_id), group.samples, group.area_m2, name_of(group.verdict));
        for (const GroupColumn& c : group.columns) lines.put(",{:.6g},{:.6g},{:.6g}", c.mean, c.least, c.greatest);
        for (const GroupCriterion& c : group.criteria)
            lines.put(",{:.6g},{:.6g},{:.6g},{}", c.area_pass, c.area_borderline, c.area_fail, name_of(c.verdict));
        lines.put("\n");
    }
    lines.commit();
}

void write_new_shadow_csv(const std::filesystem::path& path, const Study& study) {
    Lines lines(path);
    lines.put("receiver,kind,building,day,enter,exit,minutes,total_minutes,longest_sample_minutes,area_share\n");
    for (const NewShadow& shadow : study.new_shadows) {
        const Receiver& r = study.receivers.receivers[shadow.receiver];
        const SunDay& day = study.days[shadow.day];
        const auto time = [&](float second) { return to_iso8601({day.time_of(static_cast<double>(second)), 0}); };
        for (const SunInterval& episode : shadow.episodes) {
            lines.put("{},{},{},{:04}-{:02}-{:02},{},{},{:.3f},{:.3f},{:.3f},{:.4f}\n", csv_field(r.id),
                      name_of(r.kind), csv_field(r.building_id), day.year(), day.day().month, day.day().day,
                      time(episode.begin_s), time(episode.end_s),
                      static_cast<double>(episode.end_s - episode.begin_s) / 60.0, shadow.total_min,
                      shadow.longest_sample_min, shadow.area_share);
        }
    }
    lines.commit();
}

void write_cells_gpkg(const std::filesystem::path& path, const Rule& rule, const Study& study, const std::string& crs) {
    std::vector<CellColumn> columns;
    for (const Column& column : study.columns) columns.push_back({column.name, &column.values, {}});
    for (std::size_t c = 0; c < rule.criteria.size(); ++c) {
        std::vector<std::string> words;
        for (const Verdict verdict : study.criteria[c].verdict) words.emplace_back(name_of(verdict));
        columns.push_back({rule.criteria[c].id + "_value", &study.criteria[c].value, {}});
        columns.push_back({rule.criteria[c].id + "_margin", &study.criteria[c].margin, {}});
        columns.push_back({rule.criteria[c].id + "_verdict", nullptr, std::move(words)});
    }
    write_geopackage(path, study.receivers, columns, crs);
}

bool write_ground_tiff(const std::filesystem::path& path, const Study& study, const std::string& crs) {
    std::vector<RasterBand> bands;
    for (const Column& column : study.columns)
        bands.push_back({column.name, traits_of(column.metric).unit, &column.values});
    return write_geotiff(path, study.receivers, bands, crs);
}

}  // namespace skybake::io
