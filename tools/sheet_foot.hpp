#pragma once

#include <cairo.h>

#include <string>

#include "tools/sheet_layout.hpp"

namespace roundel {

// The strip at the foot of a sheet: a millimetre ruler, below it a line to be read and a smaller
// one. Millimetres.
void draw_sheet_foot(cairo_t* context, const SheetLayout& layout, const std::string& line,
                     const std::string& small_line);

}  // namespace roundel
