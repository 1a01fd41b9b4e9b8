#include "daemon/draw_arena.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace roundel {
namespace {

class ArenaDrawing {
 public:
  ArenaDrawing(cairo_t* context, const ArenaCalibration& calibration)
      : context_(context), calibration_(calibration) {}

  // A straight line of the floor.
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    constexpr int kPieces = 24;
    bool drawing = false;
    cairo_new_path(context_);
    for (int i = 0; i <= kPieces; ++i) {
      const double share = static_cast<double>(i) / kPieces;
      const auto pixel = pixel_of((1 - share) * from + share * to);
      if (pixel && drawing) cairo_line_to(context_, pixel->x(), pixel->y());
      if (pixel && !drawing) cairo_move_to(context_, pixel->x(), pixel->y());
      drawing = pixel.has_value();
    }
  }

  void stroke(double red, double green, double blue, double alpha, double width) {
    cairo_set_source_rgba(context_, 0, 0, 0, 0.5 * alpha);
    cairo_set_line_width(context_, width + 2);
    cairo_stroke_preserve(context_);
    cairo_set_source_rgba(context_, red, green, blue, alpha);
    cairo_set_line_width(context_, width);
    cairo_stroke(context_);
  }

  void ring(const Eigen::Vector3d& place) {
    constexpr double kRadius = 9;  // pixels
    const auto pixel =
        calibration_.camera.intrinsics.project(calibration_.arena_in_camera.to_camera(place));
    if (!pixel) return;
    cairo_new_path(context_);
    cairo_arc(context_, pixel->x() + 0.5, pixel->y() + 0.5, kRadius, 0, 2 * std::numbers::pi);
    stroke(0.2, 0.9, 0.9, 1, 2);
  }

  void text(const Eigen::Vector2d& place, const std::string& words) {
    const auto pixel = pixel_of(place);
    if (!pixel) return;
    cairo_move_to(context_, pixel->x() + 14, pixel->y() + 26);
    cairo_text_path(context_, words.c_str());
    cairo_set_source_rgba(context_, 0, 0, 0, 0.8);
    cairo_set_line_width(context_, 3);
    cairo_stroke_preserve(context_);
    cairo_set_source_rgb(context_, 0.2, 0.9, 0.9);
    cairo_fill(context_);
  }

 private:
  std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector2d& place) const {
    const auto pixel = calibration_.camera.intrinsics.project(
        calibration_.arena_in_camera.to_camera({place.x(), place.y(), 0}));
    if (!pixel) return std::nullopt;
    return *pixel + Eigen::Vector2d(0.5, 0.5);
  }

  cairo_t* context_;
  const ArenaCalibration& calibration_;
};

}  // namespace

double grid_step(double side_m) {
  constexpr double kMostLines = 20;
  const double least = side_m / kMostLines;
  const double decade = std::pow(10, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * decade >= least * (1 - 1e-9)) return step * decade;
  }
  return 10 * decade;
}

void draw_arena(cairo_t* context, const ArenaCalibration& calibration) {
  const double width = calibration.request.width_m, height = calibration.request.height_m;
  const double step = grid_step(std::max(width, height));
  cairo_save(context);
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_BOLD);
  cairo_set_font_size(context, 15);
  ArenaDrawing drawing(context, calibration);
  for (int i = 0; i * step < width * (1 + 1e-9); ++i) {
    drawing.line({i * step, 0}, {i * step, height});
    drawing.stroke(0.2, 0.9, 0.9, 0.35, 1);
  }
  for (int i = 0; i * step < height * (1 + 1e-9); ++i) {
    drawing.line({0, i * step}, {width, i * step});
    drawing.stroke(0.2, 0.9, 0.9, 0.35, 1);
  }
  drawing.line({0, 0}, {std::min(width, 2 * step), 0});
  drawing.stroke(1, 0.2, 0.2, 1, 3);
  drawing.line({0, 0}, {0, std::min(height, 2 * step)});
  drawing.stroke(0.1, 0.85, 0.1, 1, 3);
  for (const ArenaReference& reference : calibration.references) drawing.ring(reference.place);
  drawing.text({0, 0}, "0");
  drawing.text({width, 0}, fmt::format("x {:g} m", width));
  drawing.text({0, height}, fmt::format("y {:g} m", height));
  cairo_restore(context);
}

}  // namespace roundel
