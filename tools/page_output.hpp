#pragma once

#include <cairo.h>

#include <functional>
#include <span>
#include <string>

#include "core/grey_image.hpp"

namespace roundel {

inline constexpr double kMillimetresPerInch = 25.4;

struct PageSize {
  double width_mm = 0, height_mm = 0;
};

// Draws one page in millimetres, the origin at the page's top left corner, y down, on white.
using DrawPage = std::function<void(cairo_t*)>;

// Files that measure exactly what was drawn when they are printed unscaled. All throw
// std::runtime_error that names the file.
void write_pdf(const std::string& path, PageSize size, std::span<const DrawPage> pages);
void write_svg(const std::string& path, PageSize size, const DrawPage& page);
// Grey PNG that carries its resolution. The picture is rounded up to whole pixels, its contents are
// not scaled to them.
void write_png(const std::string& path, PageSize size, double pixels_per_mm, const DrawPage& page);

// The picture of write_png. Millimetre x is at pixel x * pixels_per_mm - 0.5, pixel (0, 0) being
// the centre of the top left one.
GreyImage render_page(PageSize size, double pixels_per_mm, const DrawPage& page);

}  // namespace roundel
