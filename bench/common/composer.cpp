#include "bench/common/composer.hpp"

#include <memory>

namespace roundel::bench {

Composer::Composer(const CameraModel& camera, const Imaging& imaging,
                   const std::vector<SceneShape>& clutter)
    : response_(imaging.gamma, imaging.srgb),
      optics_(imaging.blur_px),
      floor_(static_cast<float>(response_.light_of_grey(imaging.floor))) {
  for (const SceneShape& shape : clutter) {
    const auto figure = std::make_shared<const Figure>(shape, imaging, response_, camera);
    if (!figure->visible()) continue;
    clutter_.push_back(
        {figure->box(), figure->base_light(),
         [figure, &camera](const FineFrame& frame, CoverageGrid& base, CoverageGrid& print) {
           figure->draw(camera, frame, base, print);
         }});
  }
}

const std::vector<float>& Composer::compose(const PixelRange& piece,
                                            std::span<const Drawing> drawings) {
  const PixelRange area = piece.grown(optics_.margin());  // the scene that the pixels see
  const int factor = optics_.factor();
  fine_.assign(static_cast<std::size_t>(area.width() * factor) *
                   static_cast<std::size_t>(area.height() * factor),
               floor_);
  for (const Drawing& thing : clutter_) paint(thing, area);
  for (const Drawing& drawing : drawings) paint(drawing, area);
  optics_.filter(fine_, piece.width(), piece.height(), pixels_);
  return pixels_;
}

void Composer::paint(const Drawing& drawing, const PixelRange& area) {
  const PixelRange window = drawing.box.intersection(area);
  if (window.empty()) return;
  const int factor = optics_.factor();
  const int width = window.width() * factor, height = window.height() * factor;
  base_.reset(width, height);
  print_.reset(width, height);
  drawing.draw({window.left, window.top, factor}, base_, print_);

  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(area.width()) * factor;
  float* corner = fine_.data() + (window.top - area.top) * factor * stride +
                  static_cast<std::ptrdiff_t>(window.left - area.left) * factor;
  for (int j = 0; j < height; ++j) {
    const float* base_row = base_.row(j);
    const float* print_row = print_.row(j);
    float* cells = corner + j * stride;
    float covered = 0, printed = 0;
    for (int i = 0; i < width; ++i) {
      covered += base_row[i];
      printed += print_row[i];
      cells[i] += covered * (drawing.base_light - cells[i]) + printed;
    }
  }
}

}  // namespace roundel::bench
