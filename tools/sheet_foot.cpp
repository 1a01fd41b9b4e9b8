#include "tools/sheet_foot.hpp"

#include <fmt/format.h>

namespace roundel {
namespace {

constexpr double kRulerLineMm = 0.1;

// Every millimetre a line, every fifth longer, every tenth longest and numbered.
void draw_ruler(cairo_t* context, double left, double top, int length_mm) {
  const auto line = [&](double x0, double y0, double x1, double y1) {
    cairo_move_to(context, x0, y0);
    cairo_line_to(context, x1, y1);
  };
  cairo_set_line_width(context, kRulerLineMm);
  line(left, top, left + length_mm, top);
  for (int mm = 0; mm <= length_mm; ++mm)
    line(left + mm, top, left + mm, top + (mm % 10 == 0 ? 4 : mm % 5 == 0 ? 3 : 2));
  cairo_stroke(context);
  cairo_set_font_size(context, 2.5);
  for (int mm = 0; mm <= length_mm; mm += 10) {
    cairo_text_extents_t extents = {};
    cairo_text_extents(context, fmt::format("{}", mm).c_str(), &extents);
    cairo_move_to(context, left + mm - extents.x_advance / 2, top + 6.5);
    cairo_show_text(context, fmt::format("{}{}", mm, mm == length_mm ? " mm" : "").c_str());
  }
}

void draw_line_of_text(cairo_t* context, double left, double baseline, double font_size,
                       const std::string& text) {
  cairo_set_font_size(context, font_size);
  cairo_move_to(context, left, baseline);
  cairo_show_text(context, text.c_str());
}

}  // namespace

void draw_sheet_foot(cairo_t* context, const SheetLayout& layout, const std::string& line,
                     const std::string& small_line) {
  constexpr double kIndent = 5;
  const double left = (layout.page.width_mm - 180) / 2 + kIndent;
  cairo_set_source_rgb(context, 0, 0, 0);
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  draw_ruler(context, left, layout.ruler_top_mm + 2, 170);
  draw_line_of_text(context, left, layout.ruler_top_mm + 13, 4, line);
  draw_line_of_text(context, left, layout.ruler_top_mm + 17, 2.8, small_line);
}

}  // namespace roundel
