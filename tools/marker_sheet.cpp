#include "tools/marker_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/sheet_foot.hpp"

namespace roundel {
namespace {

constexpr double kCutLineMm = 0.1;
constexpr double kCutLineGrey = 0.5;
constexpr double kMaxLabelMm = 4;  // cap height of labels

void set_grey(cairo_t* context, double grey) {
  cairo_set_source_rgb(context, grey, grey, grey);
}

void line(cairo_t* context, double x0, double y0, double x1, double y1) {
  cairo_move_to(context, x0, y0);
  cairo_line_to(context, x1, y1);
}

struct TextSize {
  double width, height;
};

TextSize measure(cairo_t* context, const std::string& text, double font_size) {
  cairo_set_font_size(context, font_size);
  cairo_text_extents_t extents = {};
  cairo_text_extents(context, text.c_str(), &extents);
  return {extents.x_advance, font_size * 0.75};
}

// The height of a rectangle of this width-to-height ratio that just reaches from the corner of a
// unit square to the circle inscribed in it.
double corner_height(double aspect) {
  return (1 + aspect - std::sqrt(2 * aspect)) / (2 * (1 + aspect * aspect));
}

// A label in a corner of a cell, as large as the room outside the white margin allows.
// (right, bottom) choose the corner.
void draw_label(cairo_t* context, const std::string& text, double left, double top, double side,
                bool right, bool bottom) {
  const TextSize unit = measure(context, text, 1);
  const double room = 0.7 * side * corner_height(unit.width / unit.height);
  const double font_size = std::min(kMaxLabelMm, room) / unit.height;
  const TextSize size = measure(context, text, font_size);
  const double inset = 0.35 * size.height;
  cairo_move_to(context, right ? left + side - inset - size.width : left + inset,
                bottom ? top + side - inset : top + inset + size.height);
  cairo_show_text(context, text.c_str());
}

// "x" and an arrow to the right in the upper right corner: which way the marker's x axis points.
void draw_axis(cairo_t* context, double left, double top, double side) {
  const double size = std::min(kMaxLabelMm, 0.05 * side);
  const double tip = left + side - 0.3 * size;
  const double y = top + 0.7 * size;
  cairo_set_line_width(context, 0.12 * size);
  line(context, tip - 1.4 * size, y, tip, y);
  line(context, tip - 0.4 * size, y - 0.3 * size, tip, y);
  line(context, tip - 0.4 * size, y + 0.3 * size, tip, y);
  cairo_stroke(context);
  const TextSize letter = measure(context, "x", size);
  cairo_move_to(context, tip - 1.6 * size - letter.width, y + 0.27 * size);
  cairo_show_text(context, "x");
}

void draw_cell(cairo_t* context, const PrintedMarker& marker, double diameter_mm, double left,
               double top, double side) {
  set_grey(context, kCutLineGrey);
  cairo_set_line_width(context, kCutLineMm);
  cairo_rectangle(context, left, top, side, side);
  cairo_stroke(context);
  set_grey(context, 0);
  draw_label(context, marker.name, left, top, side, false, true);
  draw_label(context, marker.set, left, top, side, true, true);
  draw_label(context, fmt::format("{:.1f} mm", diameter_mm), left, top, side, false, false);
  if (marker.pattern.bits > 0) {
    draw_axis(context, left, top, side);
  }
  draw_marker(context, marker.pattern, left + side / 2, top + side / 2, diameter_mm / 2);
}

}  // namespace

PageSize bare_page(double diameter_mm) {
  return {diameter_mm * kMarginRatio, diameter_mm * kMarginRatio};
}

void draw_bare_marker(cairo_t* context, const PrintedMarker& marker, double diameter_mm) {
  const double middle = diameter_mm * kMarginRatio / 2;
  draw_marker(context, marker.pattern, middle, middle, diameter_mm / 2);
}

void draw_sheet(cairo_t* context, const SheetLayout& layout, double diameter_mm,
                std::span<const PrintedMarker> markers) {
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const auto column = static_cast<int>(i) % layout.columns;
    const auto row = static_cast<int>(i) / layout.columns;
    draw_cell(context, markers[i], diameter_mm, layout.left_mm + column * layout.cell_mm,
              layout.top_mm + row * layout.cell_mm, layout.cell_mm);
  }
  draw_sheet_foot(
      context, layout,
      fmt::format("Print at 100 % (no scaling) and measure the black disc: {:.1f} mm", diameter_mm),
      "Where it measures otherwise, give roundel the diameter that you measured.");
}

}  // namespace roundel
