#include "render/annotate.h"

#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>

#include "base/check.h"

namespace skybake {
namespace {

/// A drawing surface over a copy of the picture. Lengths are in `unit`s, a letter's height.
class Sheet {
  public:
    Sheet(std::span<std::uint8_t> rgb, const Vec2i& size)
        : rgb_(rgb),
          size_(size),
          unit_(std::max(11.0, std::min(size.x, size.y) / 36.0)),
          surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, size.x, size.y), cairo_surface_destroy),
          context_(cairo_create(surface_.get()), cairo_destroy) {
        if (cairo_surface_status(surface_.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
        for_each_pixel([](std::uint32_t& pixel, std::uint8_t* bytes) {
            pixel = static_cast<std::uint32_t>(bytes[0] << 16 | bytes[1] << 8 | bytes[2]);
        });
        cairo_surface_mark_dirty(surface_.get());
        cairo_select_font_face(context(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(context(), unit_);
    }

    cairo_t* context() const { return context_.get(); }
    double unit() const { return unit_; }
    double width() const { return size_.x; }
    double height() const { return size_.y; }

    double text_width(const std::string& text) const {
        cairo_text_extents_t extents;
        cairo_text_extents(context(), text.c_str(), &extents);
        return extents.x_advance;
    }
    /// Dark letters whose base line begins at (x, y).
    void text(double x, double y, const std::string& text) const {
        cairo_set_source_rgb(context(), 0.1, 0.1, 0.1);
        cairo_move_to(context(), x, y);
        cairo_show_text(context(), text.c_str());
    }
    void plate(double x, double y, double width, double height) const {
        cairo_set_source_rgba(context(), 1.0, 1.0, 1.0, 0.85);
        cairo_rectangle(context(), x, y, width, height);
        cairo_fill(context());
    }

    /// Puts what was drawn back into the picture.
    void finish() {
        cairo_surface_flush(surface_.get());
        for_each_pixel([](const std::uint32_t& pixel, std::uint8_t* bytes) {
            for (int c = 0; c < 3; ++c) bytes[c] = static_cast<std::uint8_t>(pixel >> (16 - 8 * c) & 255u);
        });
    }

  private:
    template <typename Visit>
    void for_each_pixel(Visit visit) {
        unsigned char* data = cairo_image_surface_get_data(surface_.get());
        const std::size_t stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get()));
        for (std::size_t y = 0; y < static_cast<std::size_t>(size_.y); ++y) {
            auto* row = reinterpret_cast<std::uint32_t*>(data + y * stride);
            for (std::size_t x = 0; x < static_cast<std::size_t>(size_.x); ++x)
                visit(row[x], rgb_.data() + 3 * (y * static_cast<std::size_t>(size_.x) + x));
        }
    }

    std::span<std::uint8_t> rgb_;
    Vec2i size_;
    double unit_;
    std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface_;
    std::unique_ptr<cairo_t, void (*)(cairo_t*)> context_;
};

/// A bar of colours with ticks, its title above.
void draw_legend(const Sheet& sheet, const Legend& legend) {
    const double unit = sheet.unit();
    const std::vector<ScaleTick> ticks = ticks_of(legend.scale);
    double label_width = 0.0;
    for (const ScaleTick& tick : ticks) label_width = std::max(label_width, sheet.text_width(tick.label));
    const double bar_width = 1.2 * unit;
    const double bar_height = std::min(16.0 * unit, sheet.height() - 6.0 * unit);
    const double width = std::max(sheet.text_width(legend.title), bar_width + 0.9 * unit + label_width) + 1.6 * unit;
    const double left = sheet.width() - width - unit;
    sheet.plate(left, unit, width, bar_height + 3.8 * unit);
    sheet.text(left + 0.8 * unit, 2.3 * unit, legend.title);
    const double x = left + 0.8 * unit;
    const double bottom = 3.6 * unit + bar_height;
    const int rows = static_cast<int>(std::ceil(bar_height));
    for (int row = 0; row < rows; ++row) {
        const double place = (row + 0.5) / rows;
        const double value = legend.scale.is_logarithmic
                                 ? legend.scale.low * std::pow(legend.scale.high / legend.scale.low, place)
                                 : legend.scale.low + place * (legend.scale.high - legend.scale.low);
        const Rgb colour = colour_of(legend.scale, value);
        cairo_set_source_rgb(sheet.context(), static_cast<double>(srgb_from_linear(colour.x)),
                             static_cast<double>(srgb_from_linear(colour.y)),
                             static_cast<double>(srgb_from_linear(colour.z)));
        cairo_rectangle(sheet.context(), x, bottom - (row + 1.0) / rows * bar_height, bar_width,
                        bar_height / rows + 0.6);
        cairo_fill(sheet.context());
    }
    for (const ScaleTick& tick : ticks) {
        const double y = bottom - tick.place * bar_height;
        cairo_set_source_rgb(sheet.context(), 0.1, 0.1, 0.1);
        cairo_rectangle(sheet.context(), x + bar_width, y - 0.04 * unit, 0.4 * unit, std::max(1.0, 0.08 * unit));
        cairo_fill(sheet.context());
        sheet.text(x + bar_width + 0.7 * unit, y + 0.35 * unit, tick.label);
    }
}

/// What the plate below on the left holds, from left to right.
struct ScaleBar {
    double length = 0.0;  // pixels
    std::string label;
};

/// The longest of 1, 2, 5, 10 … metres that takes at most a quarter of the width.
ScaleBar scale_bar(const Sheet& sheet, double metres_per_pixel) {
    const double most = std::max(8.0 * sheet.unit(), 0.25 * sheet.width()) * metres_per_pixel;
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    const double metres = (most / power >= 5.0 ? 5.0 : most / power >= 2.0 ? 2.0 : 1.0) * power;
    return {metres / metres_per_pixel,
            metres >= 1000.0 ? fmt::format("{:g} km", metres / 1000.0) : fmt::format("{:g} m", metres)};
}

/// A dark half and a light half, from (x, y) to the right; numbers above its ends.
void draw_scale_bar(const Sheet& sheet, const ScaleBar& bar, double x, double y) {
    const double unit = sheet.unit();
    for (int half = 0; half < 2; ++half) {
        const double grey = half == 0 ? 0.1 : 1.0;
        cairo_set_source_rgb(sheet.context(), grey, grey, grey);
        cairo_rectangle(sheet.context(), x + 0.5 * half * bar.length, y - 0.4 * unit, 0.5 * bar.length, 0.4 * unit);
        cairo_fill(sheet.context());
    }
    cairo_set_source_rgb(sheet.context(), 0.1, 0.1, 0.1);
    cairo_set_line_width(sheet.context(), std::max(1.0, 0.08 * unit));
    cairo_rectangle(sheet.context(), x, y - 0.4 * unit, bar.length, 0.4 * unit);
    cairo_stroke(sheet.context());
    sheet.text(x - 0.5 * sheet.text_width("0"), y - 0.75 * unit, "0");
    sheet.text(x + bar.length - 0.5 * sheet.text_width(bar.label), y - 0.75 * unit, bar.label);
}

/// An arrow about (x, y) with an N before its point.
void draw_north(const Sheet& sheet, const Vec2f& north, double x, double y) {
    const double unit = sheet.unit();
    const Vec2f toward = glm::normalize(north);
    const double ax = static_cast<double>(toward.x);
    const double ay = -static_cast<double>(toward.y);  // downwards on the sheet
    const auto along = [&](double forward, double aside) {
        return std::pair{x + (forward * ax - aside * ay) * unit, y + (forward * ay + aside * ax) * unit};
    };
    for (const double side : {-1.0, 1.0}) {
        const double grey = side < 0.0 ? 0.1 : 0.55;
        cairo_set_source_rgb(sheet.context(), grey, grey, grey);
        for (const auto& [px, py] : {along(0.8, 0.0), along(-1.7, 0.75 * side), along(-1.2, 0.0)})
            cairo_line_to(sheet.context(), px, py);
        cairo_close_path(sheet.context());
        cairo_fill(sheet.context());
    }
    const auto [nx, ny] = along(1.45, 0.0);
    sheet.text(nx - 0.5 * sheet.text_width("N"), ny + 0.36 * unit, "N");
}

/// North arrow and scale bar on one plate, below on the left.
void draw_map_marks(const Sheet& sheet, const Annotation& annotation) {
    const double unit = sheet.unit();
    const double height = 4.4 * unit;
    const double top = sheet.height() - unit - height;
    const double arrow_width = annotation.north ? 4.4 * unit : 0.8 * unit;
    const std::optional<ScaleBar> bar =
        annotation.metres_per_pixel ? std::optional(scale_bar(sheet, *annotation.metres_per_pixel)) : std::nullopt;
    const double bar_width = bar ? bar->length + 0.5 * sheet.text_width(bar->label) + 0.8 * unit : 0.0;
    sheet.plate(unit, top, arrow_width + bar_width, height);
    if (annotation.north) draw_north(sheet, *annotation.north, 3.2 * unit, top + 0.5 * height);
    if (bar) draw_scale_bar(sheet, *bar, unit + arrow_width, top + 0.5 * height + 0.8 * unit);
}

}  // namespace

void draw_annotation(std::span<std::uint8_t> rgb, const Vec2i& size, const Annotation& annotation) {
    SKYBAKE_CHECK_EQ(rgb.size(), 3 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    if (annotation.is_empty()) return;
    Sheet sheet(rgb, size);
    if (annotation.legend) draw_legend(sheet, *annotation.legend);
    if (annotation.north || annotation.metres_per_pixel) draw_map_marks(sheet, annotation);
    sheet.finish();
}

}  // namespace skybake
