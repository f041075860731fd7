// Based on: CityJSON Specifications 1.0.3, 1.1.3 and 2.0.1 (cityjson.org/specs); CityJSON text sequences: section 4
// of 2.0.1.
#include "io/cityjson/read_cityjson.h"

#include <fmt/format.h>
#include <simdjson.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>

#include "base/error.h"
#include "city/finding_codes.h"
#include "io/assembly/city_assembly.h"
#include "io/assembly/file_format.h"
#include "io/assembly/lod.h"
#include "io/cityjson/read_appearance.h"
#include "io/cityjson/read_geometry.h"
#include "io/cityjson/read_json_text.h"
#include "io/cityjson/read_object.h"

namespace skybake::io {
namespace {

using simdjson::dom::element;

constexpr std::size_t kVertexBlockBytes = 1u << 20;
constexpr std::size_t kObjectsPerTask = 32;
constexpr std::size_t kSequenceBatchBytes = 16u << 20;

struct Transform {
    Vec3d scale{1.0};
    Vec3d translate{0.0};
};

/// A parsed piece of JSON; the parser owns the tree.
struct Parsed {
    simdjson::dom::parser parser;
    element root;
};

std::optional<Vec3d> read_vec3(element e) {
    simdjson::dom::array array;
    if (e.get_array().get(array) != simdjson::SUCCESS || array.size() != 3) return std::nullopt;
    Vec3d v(0.0);
    int i = 0;
    for (const element number : array) {
        if (number.get_double().get(v[i++]) != simdjson::SUCCESS) return std::nullopt;
    }
    return v;
}

/// Everything of one file on its way into the city.
class FileReader {
  public:
    FileReader(const std::filesystem::path& path, const ReadOptions& options, CityModel& city, FindingLog& findings,
               Progress& progress)
        : path_(path),
          folder_(path.parent_path()),
          findings_(findings),
          progress_(progress),
          assembly_(path, city, findings),
          name_(assembly_.name()),
          choice_(lod_choice(options.lod)) {}

    ReadFile read() {
        file_.bytes = checked_file_size(path_);
        budget_.emplace(path_.string(), file_.bytes);
        progress_.begin("read " + name_, std::max<std::uint64_t>(file_.bytes, 1));
        read_text();
        assembly_.finish({crs_, stated_extent_, transform_.translate});
        file_.content_hash = hash_.value();
        return file_;
    }

  private:
    /// The objects of one line of a sequence, or of the one whole file, as text.
    struct Feature {
        std::vector<std::pair<std::string, std::string_view>> objects;
        std::vector<Vec3d> vertices;
        CityJsonAppearance appearance;
    };
    /// What came of a feature, before it goes into the city in order.
    struct FeatureResult {
        std::vector<ReadObject> objects;
        std::vector<Material> materials;
        std::vector<Texture> textures;
        FindingLog findings;
    };

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", path_.string(), what));
    }

    void stop_if_asked() const {
        if (progress_.stop_requested()) throw Interrupted();
    }

    std::string place_of(std::string_view id) const { return fmt::format("{}: #/CityObjects/{}", name_, id); }

    /// A first line that is a whole JSON value, with more lines behind it, makes a sequence; everything else is one
    /// document.
    void read_text() {
        std::ifstream in(path_, std::ios::binary);
        std::string line;
        std::getline(in, line);
        hash_.add(line);
        if (!in.eof()) hash_.add("\n");
        const std::size_t begin = line.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0;
        const std::string_view first = std::string_view(line).substr(begin);
        const std::size_t brace = std::min(first.find_first_not_of(" \t\r"), first.size());
        const std::size_t length = length_of_value(first.substr(brace));
        const bool is_whole_value = length != std::string_view::npos &&
                                    first.find_first_not_of(" \t\r", brace + length) == std::string_view::npos;
        if (is_whole_value) {
            while (in.good() && (in.peek() == '\n' || in.peek() == '\r' || in.peek() == ' ' || in.peek() == '\t')) {
                const char c = static_cast<char>(in.get());
                hash_.add({&c, 1});
                blank_lines_ += c == '\n';
            }
            if (in.good() && in.peek() != std::char_traits<char>::eof()) {
                read_sequence(PaddedText(std::move(line)), in);
                return;
            }
        }
        std::string text = std::move(line);
        if (!in.eof()) text += '\n';
        in.clear();
        if (!is_whole_value) {
            const std::size_t have = text.size();
            if (file_.bytes > have) {
                text.reserve(static_cast<std::size_t>(file_.bytes) + simdjson::SIMDJSON_PADDING);
                text.resize(static_cast<std::size_t>(file_.bytes));
                in.read(text.data() + have, static_cast<std::streamsize>(text.size() - have));
                text.resize(have + static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
                hash_.add(std::string_view(text).substr(have));
            }
        }
        read_document(PaddedText(std::move(text)));
    }

    // --- one document -------------------------------------------------------------------------------------------

    void read_document(const PaddedText& padded) {
        const std::string_view text = padded.view();
        std::map<std::string, std::string_view, std::less<>> members;
        if (!for_each_member(text, [&](std::string_view key, std::string_view value) {
                members.insert_or_assign(std::string(key), value);
            })) {
            fail_syntax(text);
        }
        read_header(members, text);
        progress_.advance(file_.bytes / 10);

        Feature feature;
        if (const auto found = members.find("vertices"); found != members.end()) {
            feature.vertices = read_vertices(found->second, transform_, "#/vertices", text);
        } else {
            fail("#/vertices is missing. Is the file complete?");
        }
        progress_.advance(file_.bytes / 10 * 3);
        stop_if_asked();
        const auto objects = members.find("CityObjects");
        if (objects == members.end()) fail("#/CityObjects is missing. Is it a CityJSON file?");
        if (!for_each_member(objects->second, [&](std::string_view key, std::string_view value) {
                feature.objects.emplace_back(key, value);
            })) {
            if (objects->second.substr(0, 1) == "{") fail_syntax(text);
            fail("#/CityObjects is no JSON object. Export the file again.");
        }
        std::swap(feature.appearance, appearance_);
        if (templates_.appearance) templates_.appearance = &feature.appearance;

        const std::size_t tasks = (feature.objects.size() + kObjectsPerTask - 1) / kObjectsPerTask;
        std::vector<FeatureResult> results(tasks);
        tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
            if (progress_.stop_requested()) return;
            const std::size_t begin = task * kObjectsPerTask;
            const std::size_t end = std::min(begin + kObjectsPerTask, feature.objects.size());
            std::uint64_t bytes = 0;
            for (std::size_t i = begin; i < end; ++i) {
                results[task].objects.push_back(read_one(feature, i, text, results[task].findings));
                bytes += feature.objects[i].second.size();
            }
            progress_.advance(bytes / 2);
        });
        stop_if_asked();
        const AppearanceMap map = assembly_.add_appearance(feature.appearance.materials, feature.appearance.textures);
        for (FeatureResult& result : results) {
            findings_.merge(result.findings);
            for (ReadObject& object : result.objects) add_object(std::move(object), map, map);
        }
    }

    [[noreturn]] void fail_syntax(std::string_view text, std::size_t first_line = 1) const {
        const std::string fault = json_fault(text, first_line);
        fail(fmt::format("is not JSON: {}. Export it again, or complete the download.",
                         fault.empty() ? "it ends before its end" : fault));
    }

    ReadObject read_one(const Feature& feature, std::size_t i, std::string_view text, FindingLog& findings) const {
        const auto& [id, raw] = feature.objects[i];
        thread_local simdjson::dom::parser parser;
        element e;
        if (parser.parse(raw.data(), raw.size(), false).get(e) != simdjson::SUCCESS) {
            const std::size_t line = 1 + static_cast<std::size_t>(std::count(text.data(), raw.data(), '\n'));
            const std::string fault = json_fault(raw, line);
            if (!fault.empty()) fail_syntax(text);
            fail(fmt::format("{} cannot be parsed: it is nested too deeply or holds a number out of range.",
                             place_of(id)));
        }
        const GeometryContext context{feature.vertices, &feature.appearance, &templates_, &*budget_};
        return read_object(id, e, context, choice_, place_of(id), findings);
    }

    // --- header -------------------------------------------------------------------------------------------------

    element parse(Parsed& parsed, std::string_view raw, std::string_view whole, std::size_t first_line = 1) const {
        // A copy: scalars at the end of a document need room behind them.
        if (parsed.parser.parse(raw.data(), raw.size(), true).get(parsed.root) != simdjson::SUCCESS)
            fail_syntax(whole, first_line);
        return parsed.root;
    }

    template <typename Members>
    void read_header(const Members& members, std::string_view text) {
        const auto raw = [&](std::string_view key) {
            const auto found = members.find(key);
            return found == members.end() ? std::string_view() : std::string_view(found->second);
        };
        if (raw("type") != "\"CityJSON\"") {
            if (raw("type") == "\"CityJSONFeature\"") {
                fail(
                    "begins with a CityJSONFeature; a sequence must begin with its header, an object of type CityJSON "
                    "with the transform.");
            }
            fail(
                "is JSON but no CityJSON: its type is not \"CityJSON\". It reads CityJSON 1.0, 1.1, 2.0 and "
                "CityJSONSeq.");
        }
        read_version(raw("version"));
        has_transform_ = !raw("transform").empty();
        if (has_transform_) {
            Parsed parsed;
            const element e = parse(parsed, raw("transform"), text);
            const auto read = [&](std::string_view key, Vec3d& into) {
                element value;
                if (!e.is_object() || e[key].get(value) != simdjson::SUCCESS) return false;
                const std::optional<Vec3d> v = read_vec3(value);
                if (v) into = *v;
                return v.has_value();
            };
            const bool is_read = read("scale", transform_.scale) && read("translate", transform_.translate);
            if (!is_read || transform_.scale.x == 0.0 || transform_.scale.y == 0.0 || transform_.scale.z == 0.0) {
                fail("#/transform has no scale and translate of three numbers each. Export the file again.");
            }
        }
        if (!raw("metadata").empty()) {
            Parsed parsed;
            read_metadata(parse(parsed, raw("metadata"), text));
        }
        if (!raw("appearance").empty()) {
            Parsed parsed;
            appearance_ =
                read_appearance(parse(parsed, raw("appearance"), text), folder_, name_ + ": #/appearance", findings_);
        }
        if (!raw("geometry-templates").empty()) {
            const element e = parse(template_text_, raw("geometry-templates"), text);
            simdjson::dom::array array;
            if (e.is_object() && e["templates"].get_array().get(array) == simdjson::SUCCESS) {
                for (const element item : array) templates_.templates.push_back(item);
            }
            if (e.is_object() && e["vertices-templates"].get_array().get(array) == simdjson::SUCCESS) {
                for (const element item : array) templates_.vertices.push_back(read_vec3(item).value_or(Vec3d(NAN)));
            }
            templates_.appearance = &appearance_;
        }
        if (!has_transform_ && version_ > 1.05) {
            findings_.add(make_finding("SB113", name_, "has no transform; the coordinates are taken as they are."));
        }
    }

    void read_version(std::string_view raw) {
        std::string version(raw);
        std::erase(version, '"');
        const auto parsed = std::from_chars(version.data(), version.data() + version.size(), version_);
        if (parsed.ec != std::errc()) {
            version_ = 2.0;
            findings_.add(make_finding("SB107", name_, fmt::format("states the version '{}'; read as 2.0.", version)));
        } else if (version_ < 1.0) {
            fail(
                fmt::format("is CityJSON {}, which this version does not read. It reads CityJSON 1.0, 1.1, 2.0 and "
                            "CityJSONSeq; cjio upgrades it.",
                            version));
        } else if (version_ >= 2.1) {
            findings_.add(make_finding("SB107", name_, fmt::format("is version {}; read as 2.0.", version)));
        }
    }

    void read_metadata(element metadata) {
        const std::string where = name_ + ": #/metadata";
        if (metadata.is_array() && metadata.get_array().value().size() > 0) {
            findings_.add(make_finding("SB116", where, "is a list; its first entry is used."));
            metadata = metadata.at(0).value();
        }
        if (!metadata.is_object()) {
            findings_.add(make_finding("SB116", where, "is no JSON object; ignored."));
            return;
        }
        element e;
        std::string_view text;
        if (metadata["referenceSystem"].get_string().get(text) == simdjson::SUCCESS) {
            crs_ = text;
        } else if (metadata["crs"]["epsg"].get(e) == simdjson::SUCCESS &&
                   e.is_uint64()) {  // CityJSON 0.x and early 1.0
            crs_ = fmt::format("EPSG:{}", e.get_uint64().value());
        }
        simdjson::dom::array array;
        if (metadata["geographicalExtent"].get_array().get(array) == simdjson::SUCCESS) {
            std::vector<double> numbers;
            for (const element number : array) {
                double value = 0.0;
                if (number.get_double().get(value) == simdjson::SUCCESS) numbers.push_back(value);
            }
            if (numbers.size() == 6) {
                stated_extent_ = Box3d{{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
            } else {
                findings_.add(make_finding("SB116", where, "geographicalExtent is not six numbers; ignored."));
            }
        }
    }

    /// The vertices of `raw`, in parallel over blocks of its text.
    std::vector<Vec3d> read_vertices(std::string_view raw, const Transform& transform, const std::string& place,
                                     std::string_view whole) const {
        std::vector<std::string_view> blocks;
        if (!for_each_block(raw, kVertexBlockBytes, [&](std::string_view block) { blocks.push_back(block); })) {
            if (raw.substr(0, 1) == "[") fail_syntax(whole);
            fail(place + " is no array. Export the file again.");
        }
        std::vector<std::vector<Vec3d>> parts(blocks.size());
        std::vector<std::string> faults(blocks.size());
        tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
            const std::string text = fmt::format("[{}]", blocks[b]);
            thread_local simdjson::dom::parser parser;
            simdjson::dom::array array;
            if (parser.parse(text).get_array().get(array) != simdjson::SUCCESS) {
                faults[b] = "syntax";
                return;
            }
            for (const element e : array) {
                const auto v = read_vec3(e);
                if (!v) {
                    faults[b] = fmt::format("{} holds '{}', which is not three numbers. Export the file again.", place,
                                            simdjson::minify(e).substr(0, 60));
                    return;
                }
                parts[b].push_back(transform.translate + transform.scale * *v);
            }
        });
        std::vector<Vec3d> vertices;
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            if (faults[b] == "syntax") fail_syntax(whole);
            if (!faults[b].empty()) fail(faults[b]);
            vertices.insert(vertices.end(), parts[b].begin(), parts[b].end());
        }
        return vertices;
    }

    // --- sequence -----------------------------------------------------------------------------------------------

    void read_sequence(PaddedText header, std::ifstream& in) {
        std::map<std::string, std::string_view, std::less<>> members;
        if (!json_fault(header.view()).empty()) fail_syntax(header.view());
        for_each_member(header.view(), [&](std::string_view key, std::string_view value) {
            members.insert_or_assign(std::string(key), value);
        });
        read_header(members, header.view());
        if (!has_transform_) {
            fail(
                "#/transform is missing in the header of the sequence: the vertices of its features have no place "
                "without it. Export it again.");
        }
        template_map_ = assembly_.add_appearance(appearance_.materials, appearance_.textures);
        std::size_t line_number = 2 + blank_lines_;
        std::vector<std::pair<std::size_t, std::string>> batch;
        std::size_t batch_bytes = 0;
        std::string line;
        while (std::getline(in, line)) {
            hash_.add(line);
            if (!in.eof()) hash_.add("\n");
            batch_bytes += line.size();
            if (line.find_first_not_of(" \t\r") != std::string::npos) batch.emplace_back(line_number, std::move(line));
            line.clear();
            ++line_number;
            if (batch_bytes >= kSequenceBatchBytes) {
                read_batch(batch);
                progress_.advance(batch_bytes);
                batch_bytes = 0;
                batch.clear();
            }
        }
        read_batch(batch);
        progress_.advance(batch_bytes);
    }

    void read_batch(const std::vector<std::pair<std::size_t, std::string>>& batch) {
        stop_if_asked();
        std::vector<FeatureResult> results(batch.size());
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batch.size(), 8),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t i = range.begin(); i < range.end() && !progress_.stop_requested(); ++i) {
                                  try {
                                      results[i] = read_feature(batch[i].second, batch[i].first);
                                  } catch (const InputError& error) {  // one line is a part of the input, not its whole
                                      const std::string what = error.what();
                                      results[i] = FeatureResult();
                                      results[i].findings.add(
                                          make_finding("SB119", fmt::format("{}: line {}", name_, batch[i].first),
                                                       what.substr(what.find(": ") + 2) + " The line is left out."));
                                  }
                              }
                          });
        stop_if_asked();
        for (FeatureResult& result : results) {
            findings_.merge(result.findings);
            const AppearanceMap map = assembly_.add_appearance(result.materials, result.textures);
            for (ReadObject& object : result.objects) add_object(std::move(object), map, template_map_);
        }
    }

    FeatureResult read_feature(const std::string& line, std::size_t line_number) const {
        FeatureResult result;
        thread_local simdjson::dom::parser parser;
        element root;
        const simdjson::error_code error = parser.parse(line).get(root);
        if (error != simdjson::SUCCESS) {
            const std::string fault = json_fault(line, line_number);
            fail("is not JSON: " + (fault.empty() ? std::string(simdjson::error_message(error)) : fault) + ".");
        }
        std::string_view type;
        if (!root.is_object() || root["type"].get_string().get(type) != simdjson::SUCCESS ||
            type != "CityJSONFeature") {
            fail("is no CityJSONFeature.");
        }
        Feature feature;
        simdjson::dom::array vertices;
        if (root["vertices"].get_array().get(vertices) != simdjson::SUCCESS) fail("the feature has no vertices.");
        for (const element e : vertices) {
            const auto v = read_vec3(e);
            if (!v) fail("a vertex is not three numbers.");
            feature.vertices.push_back(transform_.translate + transform_.scale * *v);
        }
        element e;
        if (root["appearance"].get(e) == simdjson::SUCCESS && e.is_object()) {
            feature.appearance = read_appearance(
                e, folder_, fmt::format("{}: line {}: #/appearance", name_, line_number), result.findings);
        }
        simdjson::dom::object objects;
        if (root["CityObjects"].get_object().get(objects) != simdjson::SUCCESS) fail("the feature has no CityObjects.");
        const GeometryContext context{feature.vertices, &feature.appearance, &templates_, &*budget_};
        for (const auto& [id, object] : objects) {
            result.objects.push_back(read_object(id, object, context, choice_, place_of(id), result.findings));
        }
        result.materials = std::move(feature.appearance.materials);
        result.textures = std::move(feature.appearance.textures);
        return result;
    }

    void add_object(ReadObject read, const AppearanceMap& own, const AppearanceMap& of_templates) {
        const AppearanceMap& map = read.is_appearance_of_templates ? of_templates : own;
        assembly_.add(std::move(read), map);
    }

    std::filesystem::path path_;
    std::filesystem::path folder_;
    FindingLog& findings_;
    Progress& progress_;
    CityAssembly assembly_;
    const std::string& name_;
    LodChoice choice_;
    ReadFile file_;
    ContentHash hash_;
    std::size_t blank_lines_ = 0;

    double version_ = 2.0;
    bool has_transform_ = false;
    Transform transform_;
    std::string crs_;
    std::optional<Box3d> stated_extent_;
    CityJsonAppearance appearance_;
    Parsed template_text_;
    CityJsonTemplates templates_;
    AppearanceMap template_map_;
    mutable std::optional<CornerBudget> budget_;  // taken from by the tasks that read objects
};

}  // namespace

ReadFile read_cityjson(const std::filesystem::path& path, const ReadOptions& options, CityModel& city,
                       FindingLog& findings, Progress& progress) {
    return FileReader(path, options, city, findings, progress).read();
}

}  // namespace skybake::io
