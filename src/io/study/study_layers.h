// A study's columns as layers of a bake: titles, units and legends.
#pragma once

#include "io/manifest/write_layers.h"
#include "study/study.h"

namespace skybake::io {

/// A column's layer without values: "RULE_METRIC_DATE".
BakeLayer study_layer(const Rule& rule, const Study& study, const Column& column);

/// The layer of what a column is after less before: "RULE_METRIC_DATE_change".
BakeLayer change_layer(const Rule& rule, const Study& study, const Column& column);

/// Range and legend by the layer's values: edges of a round width, among them the rule's thresholds for the metric; of
/// changes about 0.
void settle_legend(BakeLayer& layer, const Rule& rule, Metric metric);

}  // namespace skybake::io
