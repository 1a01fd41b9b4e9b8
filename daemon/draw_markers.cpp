#include "daemon/draw_markers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace roundel {
namespace {

struct Colour {
  double red, green, blue;
};
constexpr Colour kOutline = {1.0, 0.75, 0.0};
constexpr Colour kAxes[3] = {{1.0, 0.2, 0.2}, {0.1, 0.85, 0.1}, {0.3, 0.5, 1.0}};

// Strokes the path over a darker, wider one, so that it shows on black and on white.
void stroke_with_halo(cairo_t* context, Colour colour, double width) {
  cairo_set_line_width(context, 2 * width);
  cairo_set_source_rgba(context, 0, 0, 0, 0.6);
  cairo_stroke_preserve(context);
  cairo_set_line_width(context, width);
  cairo_set_source_rgb(context, colour.red, colour.green, colour.blue);
  cairo_stroke(context);
}

void draw_outline(cairo_t* context, const Ellipse& ellipse, double width) {
  cairo_save(context);
  cairo_translate(context, ellipse.u + 0.5, ellipse.v + 0.5);
  cairo_rotate(context, ellipse.angle);
  cairo_scale(context, ellipse.a, ellipse.b);
  cairo_new_path(context);
  cairo_arc(context, 0, 0, 1, 0, 2 * std::numbers::pi);
  cairo_restore(context);  // the path stays, the line is not squeezed with it
  stroke_with_halo(context, kOutline, width);
}

void draw_axes(cairo_t* context, const Marker& marker, const CameraModel& camera, double length_m,
               double width) {
  const auto origin = camera.project(marker.pose.position);
  for (int axis = 2; origin && axis >= 0; --axis) {
    const auto tip = camera.project(marker.pose.to_camera(length_m * Eigen::Vector3d::Unit(axis)));
    if (!tip) {
      continue;
    }
    cairo_new_path(context);
    cairo_move_to(context, origin->x() + 0.5, origin->y() + 0.5);
    cairo_line_to(context, tip->x() + 0.5, tip->y() + 0.5);
    stroke_with_halo(context, kAxes[axis], width);
  }
}

void draw_id(cairo_t* context, const Marker& marker, double size) {
  const std::string text = marker.id >= 0 ? fmt::format("{}", marker.id) : "?";
  cairo_set_font_size(context, size);
  cairo_text_extents_t extents = {};
  cairo_text_extents(context, text.c_str(), &extents);
  cairo_new_path(context);
  cairo_move_to(context, marker.ellipse.u + 0.75 * marker.ellipse.a + 0.5,
                marker.ellipse.v - 0.75 * marker.ellipse.a + 0.5);
  cairo_text_path(context, text.c_str());
  cairo_set_line_width(context, 0.2 * size);
  cairo_set_source_rgba(context, 0, 0, 0, 0.8);
  cairo_stroke_preserve(context);
  cairo_set_source_rgb(context, kOutline.red, kOutline.green, kOutline.blue);
  cairo_fill(context);
}

}  // namespace

void draw_found_markers(cairo_t* context, std::span<const Marker> markers,
                        const std::optional<CameraModel>& camera, double diameter_m) {
  cairo_save(context);
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_BOLD);
  cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  for (const Marker& marker : markers) {
    const double width = std::clamp(marker.ellipse.a / 16, 1.0, 4.0);
    draw_outline(context, marker.ellipse, width);
    if (marker.has_pose && camera) {
      draw_axes(context, marker, *camera, diameter_m / 2, width);
    }
    draw_id(context, marker, std::clamp(marker.ellipse.a * 0.7, 11.0, 40.0));
  }
  cairo_restore(context);
}

CairoSurface grey_surface(const LumaView& frame) {
  CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, frame.width, frame.height));
  unsigned char* data = cairo_image_surface_get_data(surface.get());
  if (data == nullptr) {
    throw std::runtime_error(
        fmt::format("no picture of {}x{} can be made", frame.width, frame.height));
  }
  const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface.get());
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      std::fill_n(data + v * stride + 4 * u, 4, frame.at(u, v));
    }
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

void save_annotated_png(const std::string& path, const LumaView& frame,
                        std::span<const Marker> markers, const std::optional<CameraModel>& camera,
                        double diameter_m) {
  const CairoSurface surface = grey_surface(frame);
  const CairoContext context(cairo_create(surface.get()));
  draw_found_markers(context.get(), markers, camera, diameter_m);
  const cairo_status_t status = cairo_surface_write_to_png(surface.get(), path.c_str());
  if (status != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error(
        fmt::format("{} can't be written: {}", path, cairo_status_to_string(status)));
  }
}

}  // namespace roundel
