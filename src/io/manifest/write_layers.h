// Numbers of a study on the texels of a bake: layers that the walkthrough shows (docs/formats.md, "Layers").
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "io/manifest/read_bake.h"

namespace skybake::io {

enum class LayerKind : std::uint8_t { sequential, diverging };

struct BakeLayer {
    std::string id;  // [a-z0-9_.-]+
    std::string title_en, title_de;
    std::string unit;  // "h", "%", "kWh/m2", "lx", "1"
    LayerKind kind = LayerKind::sequential;
    double minimum = 0.0;       // value of grey 0
    double maximum = 1.0;       // value of grey 255, above minimum
    std::vector<double> edges;  // of a stepped legend, ascending; empty: continuous
    /// [page][texel], as large as the page, row 0 on top; NaN where there is no value.
    std::vector<std::vector<float>> values;
};

/// Values for the picture: texels of a chart without a value (its gutter, buried texels) get the mean of their
/// neighbours within the chart, from ring to ring; charts without any value keep NaN.
void fill_charts(const LightmapPage& page, std::vector<float>& values);

/// Adds the layers to the bake, in place of those of the same id: EXRs (channel `value`) and 8-bit pictures (linear,
/// NaN as 0, or as the end of the range that is nearest to it) beside the light, and the manifest last. Throws
/// InputError when the place cannot be written, Interrupted when the user stops; the manifest then is as it was.
void write_layers(const StoredBake& bake, const std::vector<BakeLayer>& layers, Progress& progress);

}  // namespace skybake::io
