#include "io/study/study_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "io/study/report_words.h"
#include "io/study/stepped_scale.h"
#include "io/study/study_tables.h"

namespace skybake::io {
namespace {

std::string id_of(const Rule& rule, const Study& study, const Column& column) {
    std::string id = fmt::format("{}_{}", rule.id, name_of(column.metric));
    if (column.day) {
        const SunDay& day = study.days[*column.day];
        id += fmt::format("_{:04}-{:02}-{:02}", day.year(), day.day().month, day.day().day);
    }
    if (column.instant) id += fmt::format("_{}", study.instants[*column.instant]);
    // Rules of the user's may be called anything.
    for (char& c : id) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
        if (!is_plain) c = '-';
    }
    return id;
}

/// "Hours of direct sun, 21 March 2026 (bre209-amenity)".
std::string title_of(const Rule& rule, const Study& study, const Column& column, const Words& words, bool is_change) {
    std::string text = words.metric(column.metric);
    if (is_change) text += words(", change", ", Änderung");
    if (column.day) {
        const SunDay& day = study.days[*column.day];
        text += fmt::format(", {} {}", words.day(day.day()), day.year());
    }
    if (column.instant) text += fmt::format(", {}", study.instants[*column.instant]);
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    return fmt::format("{} ({})", text, rule.id);
}

BakeLayer named_layer(const Rule& rule, const Study& study, const Column& column, bool is_change) {
    BakeLayer layer;
    layer.id = id_of(rule, study, column);
    if (is_change) layer.id += "_change";
    layer.title_en = title_of(rule, study, column, Words(Language::english), is_change);
    layer.title_de = title_of(rule, study, column, Words(Language::german), is_change);
    layer.unit = traits_of(column.metric).unit;
    layer.kind = is_change ? LayerKind::diverging : LayerKind::sequential;
    return layer;
}

}  // namespace

BakeLayer study_layer(const Rule& rule, const Study& study, const Column& column) {
    return named_layer(rule, study, column, false);
}

BakeLayer change_layer(const Rule& rule, const Study& study, const Column& column) {
    return named_layer(rule, study, column, true);
}

void settle_legend(BakeLayer& layer, const Rule& rule, Metric metric) {
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    for (const std::vector<float>& page : layer.values) {
        for (const float value : page) {
            if (std::isnan(value)) continue;
            least = std::min(least, static_cast<double>(value));
            greatest = std::max(greatest, static_cast<double>(value));
        }
    }
    if (!(least <= greatest)) least = greatest = 0.0;  // no texel has a value
    if (layer.kind == LayerKind::diverging) {
        const double most = std::max(std::abs(least), std::abs(greatest));
        const double range = difference_scale(most, traits_of(metric).least_change).edges.back();
        // Half a grey level of 2 · range / 255 is the least that the picture can tell from none.
        const double least_change = std::max(traits_of(metric).least_change, round_step(range / 255.0));
        layer.edges = difference_scale(most, least_change).edges;
        layer.maximum = layer.edges.back();
        layer.minimum = -layer.maximum;
    } else {
        layer.edges = stepped_scale(least, greatest, thresholds_of(rule, metric)).edges;
        layer.minimum = layer.edges.front();
        layer.maximum = layer.edges.back();
    }
}

}  // namespace skybake::io
