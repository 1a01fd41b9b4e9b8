#include "tools/page_output.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "daemon/cairo_pointer.hpp"
#include "daemon/image_file.hpp"

namespace roundel {
namespace {

constexpr double kPointsPerMillimetre = 72.0 / kMillimetresPerInch;

void draw(const DrawPage& page, cairo_t* context) {
  cairo_save(context);
  cairo_set_source_rgb(context, 1, 1, 1);
  cairo_paint(context);
  page(context);
  cairo_restore(context);
}

// Vector files are written as they are drawn; what went wrong shows up when they are finished.
void finish(const std::string& path, cairo_surface_t* surface, cairo_t* context) {
  cairo_surface_finish(surface);
  cairo_status_t status = cairo_status(context);
  if (status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_status(surface);
  }
  if (status != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error(
        fmt::format("{} can't be written: {}", path, cairo_status_to_string(status)));
  }
}

}  // namespace

void write_pdf(const std::string& path, PageSize size, std::span<const DrawPage> pages) {
  const CairoSurface surface(cairo_pdf_surface_create(
      path.c_str(), size.width_mm * kPointsPerMillimetre, size.height_mm * kPointsPerMillimetre));
  const CairoContext context(cairo_create(surface.get()));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, "Roundel markers");
  cairo_scale(context.get(), kPointsPerMillimetre, kPointsPerMillimetre);
  for (const DrawPage& page : pages) {
    draw(page, context.get());
    cairo_show_page(context.get());
  }
  finish(path, surface.get(), context.get());
}

void write_svg(const std::string& path, PageSize size, const DrawPage& page) {
  const CairoSurface surface(cairo_svg_surface_create(path.c_str(), size.width_mm, size.height_mm));
  cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_MM);
  const CairoContext context(cairo_create(surface.get()));
  draw(page, context.get());
  finish(path, surface.get(), context.get());
}

GreyImage render_page(PageSize size, double pixels_per_mm, const DrawPage& page) {
  // A page that is whole but for rounding must not grow by a pixel.
  const auto pixels = [&](double mm) {
    return static_cast<int>(std::ceil(mm * pixels_per_mm - 1e-6));
  };
  GreyImage image;
  image.resize(pixels(size.width_mm), pixels(size.height_mm));
  const CairoSurface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height));
  const CairoContext context(cairo_create(surface.get()));
  cairo_scale(context.get(), pixels_per_mm, pixels_per_mm);
  draw(page, context.get());
  cairo_surface_flush(surface.get());
  if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error(fmt::format("a picture of {}x{} pixels can't be drawn: {}",
                                         image.width, image.height,
                                         cairo_status_to_string(cairo_status(context.get()))));
  }
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface.get());
  std::uint8_t* pixel = image.pixels.data();
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      *pixel++ = data[v * stride + u * 4 + 1];  // all channels are the same; this is green
    }
  }
  return image;
}

void write_png(const std::string& path, PageSize size, double pixels_per_mm, const DrawPage& page) {
  save_png(path, render_page(size, pixels_per_mm, page).view(), pixels_per_mm * 1000);
}

}  // namespace roundel
