#pragma once

#include <cairo.h>

#include <span>
#include <string>

#include "tools/marker_pattern.hpp"
#include "tools/sheet_layout.hpp"

namespace roundel {

// A marker and the words that go with it.
struct PrintedMarker {
  MarkerPattern pattern;
  std::string name;  // "id 7"; in the lower left corner of the cell
  std::string set;   // "8 bits"; in the lower right corner
};

// A marker alone with its white margin, on a page as large as that: nothing else is drawn.
PageSize bare_page(double diameter_mm);
void draw_bare_marker(cairo_t* context, const PrintedMarker& marker, double diameter_mm);

// A sheet in millimetres: at most layout.cells() markers, row by row, with cut lines around every
// cell and labels in its corners (outside the white margin); below them a millimetre ruler and the
// diameter to measure after printing.
void draw_sheet(cairo_t* context, const SheetLayout& layout, double diameter_mm,
                std::span<const PrintedMarker> markers);

}  // namespace roundel
