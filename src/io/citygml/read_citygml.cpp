// Based on: CityGML 1.0 (OGC 08-007r1), 2.0 (OGC 12-019), 3.0 GML encoding (OGC 21-006r2).
#include "io/citygml/read_citygml.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <unordered_set>

#include "base/error.h"
#include "base/hash_rng.h"
#include "city/finding_codes.h"
#include "city/georeference.h"
#include "io/assembly/file_format.h"
#include "io/assembly/lod.h"
#include "io/citygml/gml_appearance.h"
#include "io/citygml/gml_geometry.h"
#include "io/citygml/gml_numbers.h"
#include "io/citygml/gml_object.h"
#include "io/xml/xml_scan.h"
#include "io/xml/xml_tree.h"

namespace skybake::io {
namespace {

constexpr std::size_t kBatchBytes = 16u << 20;
/// Names of reference systems that are kept to compare them.
constexpr std::size_t kMostSystems = 16;
/// Shapes in other objects that refer to shapes in other objects …
constexpr int kMostRounds = 8;

std::string_view attribute_of(const XmlStart& element, std::string_view name) {
    for (const XmlAttribute& attribute : element.attributes) {
        if (attribute.name == name) return attribute.value;
    }
    return {};
}

/// "#id" of a property that may hold geometry; empty for other references.
std::string_view geometry_reference(const XmlStart& element) {
    if (!is_geometry_property(element.name)) return {};
    const std::string_view reference = attribute_of(element, "href");
    return reference.substr(0, 1) == "#" ? reference.substr(1) : std::string_view();
}

/// The number of the horizontal system in a name of one, to tell whether two names mean the same; else the name.
std::string system_key(std::string_view name) {
    for (std::size_t at = 0; at < name.size();) {
        if (!std::isdigit(static_cast<unsigned char>(name[at]))) {
            ++at;
            continue;
        }
        const std::size_t end = std::min(name.find_first_not_of("0123456789", at), name.size());
        if (end - at >= 4) return std::string(name.substr(at, end - at));
        at = end;
    }
    return std::string(name);
}

/// The first time through the file: root, reference systems, extent, appearances, and references out of objects.
class Survey final : public XmlVisitor {
  public:
    Survey(const std::filesystem::path& path, GmlAppearance& appearance, FindingLog& findings)
        : path_(path), appearance_(appearance), findings_(findings) {}

    std::vector<std::string> systems;  // in order; the first one counts
    std::optional<Box3d> stated_extent;
    std::unordered_set<std::string> wanted;  // ids that objects refer to outside themselves

    void start(const XmlStart& element) override {
        if (depth_ == 0) check_root(element);
        if (const std::string_view system = attribute_of(element, "srsName"); !system.empty()) note_system(system);
        if (tree_.is_open()) {
            tree_.start(element);
        } else if (is_captured(element)) {
            tree_ = XmlTree(names_);
            tree_.start(element);
        } else if (appearance_depth_ == 0 && depth_ >= 2) {
            if (const std::string_view id = attribute_of(element, "id"); !id.empty()) ids_.insert(hash_of(id));
            if (const std::string_view id = geometry_reference(element); !id.empty()) references_.emplace(id);
        }
        if (depth_ == 1) is_extent_ = element.name == "boundedBy";
        if (element.name == "Appearance" && appearance_depth_ == 0) {
            appearance_depth_ = depth_ + 1;
            theme_.clear();
        }
        ++depth_;
    }

    void text(std::string_view piece) override {
        if (tree_.is_open()) tree_.text(piece);
    }

    void end() override {
        --depth_;
        if (tree_.is_open()) {
            tree_.end();
            if (!tree_.is_open()) take();
        }
        if (appearance_depth_ == depth_ + 1) appearance_depth_ = 0;
        if (depth_ == 2) {
            for (const std::string& id : references_) {
                if (ids_.count(hash_of(id)) == 0) wanted.insert(id);
            }
            references_.clear();
            ids_.clear();
        }
    }

  private:
    void check_root(const XmlStart& element) {
        if (element.name == "CityModel" || element.name == "FeatureCollection") return;
        throw InputError(fmt::format(
            "{}:{}: is XML but no CityGML: its root is '{}', not CityModel. It reads CityGML 1.0, 2.0 and 3.0.",
            path_.string(), element.line, element.name.substr(0, 80)));
    }

    bool is_captured(const XmlStart& element) const {
        if (appearance_depth_ > 0) {
            return element.name == "theme" || element.name == "ParameterizedTexture" ||
                   element.name == "GeoreferencedTexture" || element.name == "X3DMaterial";
        }
        return depth_ == 2 && is_extent_ && element.name == "Envelope";
    }

    void take() {
        const XmlElement e = tree_.root();
        if (e.name() == "theme") {
            theme_ = e.text();
        } else if (e.name() == "Envelope") {
            std::vector<double> low, high;
            const XmlElement lower = e.child("lowerCorner"), upper = e.child("upperCorner");
            if (lower && upper && read_numbers(lower.text(), low) && read_numbers(upper.text(), high) &&
                low.size() == 3 && high.size() == 3) {
                stated_extent = Box3d{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
            }
        } else {
            appearance_.add(e, theme_, findings_);
        }
    }

    void note_system(std::string_view system) {
        if (systems.size() < kMostSystems && std::find(systems.begin(), systems.end(), system) == systems.end())
            systems.emplace_back(system);
    }

    const std::filesystem::path& path_;
    GmlAppearance& appearance_;
    FindingLog& findings_;
    XmlNames names_;
    XmlTree tree_{names_};
    std::size_t depth_ = 0;
    std::size_t appearance_depth_ = 0;  // of the open Appearance's children; 0 outside
    bool is_extent_ = false;
    std::string theme_;
    std::unordered_set<std::uint64_t> ids_;  // of the object at hand, hashed
    std::set<std::string> references_;       // of the object at hand
};

/// Keeps the elements that other objects refer to.
class LibraryVisitor final : public XmlVisitor {
  public:
    LibraryVisitor(const std::unordered_set<std::string>& wanted, XmlNames& names,
                   std::vector<std::unique_ptr<XmlTree>>& trees)
        : wanted_(wanted), names_(names), trees_(trees) {}

    void start(const XmlStart& element) override {
        if (is_open_) {
            trees_.back()->start(element);
            return;
        }
        const std::string_view id = attribute_of(element, "id");
        if (id.empty() || wanted_.count(std::string(id)) == 0) return;
        trees_.push_back(std::make_unique<XmlTree>(names_));
        trees_.back()->start(element);
        is_open_ = true;
    }
    void text(std::string_view piece) override {
        if (is_open_) trees_.back()->text(piece);
    }
    void end() override {
        if (!is_open_) return;
        trees_.back()->end();
        is_open_ = trees_.back()->is_open();
    }

  private:
    const std::unordered_set<std::string>& wanted_;
    XmlNames& names_;
    std::vector<std::unique_ptr<XmlTree>>& trees_;
    bool is_open_ = false;
};

/// Calls `f` for the element and all below it.
template <typename F>
void for_each_below(XmlElement e, F&& f) {
    f(e);
    e.for_each_child([&](XmlElement c) { for_each_below(c, f); });
}

/// The last time through the file: hands over each object as a tree.
class ObjectVisitor final : public XmlVisitor {
  public:
    struct Unit {
        std::unique_ptr<XmlTree> tree;
        std::size_t number = 0;  // which object of the file
        bool has_references = false;
    };
    ObjectVisitor(XmlNames& names, std::function<void(std::vector<Unit>)> take)
        : names_(names), take_(std::move(take)) {}

    void start(const XmlStart& element) override {
        if (depth_ == 1)
            is_object_ = element.name.find("appearance") == std::string_view::npos && element.name != "boundedBy";
        if (depth_ == 2 && is_object_ && element.name != "Appearance" && element.name != "Envelope") {
            batch_.push_back({std::make_unique<XmlTree>(names_), number_++, false});
            is_open_ = true;
        }
        if (is_open_) {
            batch_.back().tree->start(element);
            batch_.back().has_references = batch_.back().has_references || !geometry_reference(element).empty();
        }
        ++depth_;
    }
    void text(std::string_view piece) override {
        if (is_open_) batch_.back().tree->text(piece);
    }
    void end() override {
        --depth_;
        if (!is_open_) return;
        batch_.back().tree->end();
        if (depth_ != 2) return;
        is_open_ = false;
        bytes_ += batch_.back().tree->bytes();
        if (bytes_ >= kBatchBytes) flush();
    }
    void flush() {
        take_(std::move(batch_));
        batch_.clear();
        bytes_ = 0;
    }

  private:
    XmlNames& names_;
    std::function<void(std::vector<Unit>)> take_;
    std::vector<Unit> batch_;
    std::size_t bytes_ = 0;
    std::size_t number_ = 0;
    std::size_t depth_ = 0;
    bool is_object_ = false;
    bool is_open_ = false;
};

class FileReader {
  public:
    FileReader(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
               Progress& progress)
        : path_(path),
          findings_(findings),
          progress_(progress),
          choice_(lod_choice(options.lod)),
          assembly_(path, city, findings),
          appearance_(path.parent_path(), assembly_.name()) {}

    ReadFile read() {
        ReadFile file;
        file.bytes = checked_file_size(path_);
        budget_.emplace(path_.string(), file.bytes);
        progress_.begin("read " + assembly_.name(), std::max<std::uint64_t>(2 * file.bytes, 1));
        const auto advance = [&](std::string_view bytes) { progress_.advance(bytes.size()); };
        ContentHash hash;
        Survey survey(path_, appearance_, findings_);
        scan_xml(path_, survey, progress_, [&](std::string_view bytes) {
            hash.add(bytes);
            advance(bytes);
        });
        file.content_hash = hash.value();
        appearance_.finish(findings_);
        appearance_map_ = assembly_.add_appearance(appearance_.materials, appearance_.textures);
        note_systems(survey.systems);
        read_library(std::move(survey.wanted));

        ObjectVisitor objects(names_, [&](std::vector<ObjectVisitor::Unit> batch) { read_batch(batch); });
        scan_xml(path_, objects, progress_, advance);
        objects.flush();
        assembly_.finish({crs_, survey.stated_extent, Vec3d(0.0)});
        return file;
    }

  private:
    void note_systems(const std::vector<std::string>& systems) {
        if (systems.empty()) return;
        crs_ = systems.front();
        is_geographic_ = is_geographic_crs(crs_);
        for (const std::string& system : systems) {
            if (system_key(system) == system_key(crs_)) continue;
            findings_.add(make_finding("SB306", assembly_.name(),
                                       fmt::format("names '{}' and '{}'; the first is used for all.", crs_, system)));
        }
    }

    void read_library(std::unordered_set<std::string> wanted) {
        for (int round = 0; !wanted.empty() && round < kMostRounds; ++round) {
            const std::size_t first = library_trees_.size();
            LibraryVisitor visitor(wanted, names_, library_trees_);
            scan_xml(path_, visitor, progress_);
            std::unordered_set<std::string> inside;
            for (std::size_t i = first; i < library_trees_.size(); ++i) {
                for_each_below(library_trees_[i]->root(), [&](XmlElement e) {
                    if (const std::string_view id = e.attribute("id"); !id.empty()) library_.emplace(id, e);
                    const std::string_view reference = e.attribute("href");
                    if (reference.substr(0, 1) == "#" && is_geometry_property(e.name()))
                        inside.emplace(reference.substr(1));
                });
            }
            std::erase_if(inside,
                          [&](const std::string& id) { return library_.count(id) > 0 || wanted.count(id) > 0; });
            wanted = std::move(inside);
        }
    }

    void read_batch(const std::vector<ObjectVisitor::Unit>& batch) {
        struct Result {
            std::vector<ReadObject> objects;
            FindingLog findings;
        };
        std::vector<Result> results(batch.size());
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, batch.size(), 4), [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t i = range.begin(); i < range.end(); ++i) {
                    if (progress_.stop_requested()) return;
                    const XmlElement feature = batch[i].tree->root();
                    GmlContext context;
                    context.appearance = &appearance_;
                    context.library = &library_;
                    context.budget = &*budget_;
                    context.file = assembly_.name();
                    context.is_geographic = is_geographic_;
                    if (batch[i].has_references) {
                        for_each_below(feature, [&](XmlElement e) {
                            const std::string_view id = e.attribute("id");
                            if (!id.empty()) context.ids.emplace(id, e);
                        });
                    }
                    const std::string nameless = fmt::format("{}-{}", feature.name(), batch[i].number + 1);
                    read_gml_object(feature, context, choice_, nameless, results[i].objects, results[i].findings);
                }
            });
        if (progress_.stop_requested()) throw Interrupted();
        for (Result& result : results) {
            findings_.merge(result.findings);
            for (ReadObject& object : result.objects) assembly_.add(std::move(object), appearance_map_);
        }
    }

    std::filesystem::path path_;
    FindingLog& findings_;
    Progress& progress_;
    LodChoice choice_;
    CityAssembly assembly_;
    GmlAppearance appearance_;
    AppearanceMap appearance_map_;
    std::string crs_;
    bool is_geographic_ = false;
    XmlNames names_;
    std::vector<std::unique_ptr<XmlTree>> library_trees_;
    GmlLibrary library_;
    std::optional<CornerBudget> budget_;
};

}  // namespace

ReadFile read_citygml(const std::filesystem::path& path, const ReadOptions& options, CityModel& city,
                      FindingLog& findings, Progress& progress) {
    return FileReader(path, options, city, findings, progress).read();
}

}  // namespace skybake::io
