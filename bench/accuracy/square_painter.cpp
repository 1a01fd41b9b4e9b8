#include "bench/accuracy/square_painter.hpp"

#include <utility>

#include "simulator/random.hpp"

namespace roundel::bench {

namespace {

constexpr int kTile = 160;  // pixels

}  // namespace

SquarePainter::SquarePainter(const Experiment& experiment, std::vector<SquarePattern> patterns)
    : experiment_(experiment),
      patterns_(std::move(patterns)),
      image_{0, 0, experiment.camera.width, experiment.camera.height},
      response_(experiment.imaging.gamma, experiment.imaging.srgb),
      optics_(experiment.imaging.blur_px),
      noise_(experiment.imaging.noise_sigma, experiment.camera.width),
      floor_(static_cast<float>(response_.light_of_grey(experiment.imaging.floor))),
      white_(static_cast<float>(response_.light_of_grey(experiment.imaging.white))),
      ink_(static_cast<float>(response_.light_of_grey(experiment.imaging.black)) - white_) {
  for (const SceneShape& shape : experiment.clutter) {
    clutter_.emplace_back(shape, experiment.imaging, response_, experiment.camera);
  }
  grey_.resize(static_cast<std::size_t>(image_.width()) *
               static_cast<std::size_t>(image_.height()));
  for (int top = 0; top < image_.bottom; top += kTile) {
    for (int left = 0; left < image_.right; left += kTile) {
      compose(Box{left, top, left + kTile, top + kTile}.intersection(image_), {});
    }
  }
  empty_ = grey_;
}

void SquarePainter::paint(const View& view, GreyImage& out) {
  std::vector<SquareFigure> tags;
  tags.reserve(view.markers.size());
  for (const PlacedMarker& marker : view.markers) {
    tags.emplace_back(experiment_, marker,
                      patterns_[static_cast<std::size_t>(marker.number) % patterns_.size()]);
  }
  grey_ = empty_;
  // Where two tags' surroundings overlap, both are composed twice, with the same result.
  for (const SquareFigure& tag : tags) {
    const Box reach = tag.box().grown(optics_.margin()).intersection(image_);
    if (!reach.empty()) compose(reach, tags);
  }

  out.resize(image_.right, image_.bottom);
  Random rows(view.noise_seed);
  for (int v = 0; v < out.height; ++v) {
    const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(v) * out.width;
    noise_.apply(grey_.data() + start, out.pixels.data() + start, out.width, rows.bits());
  }
}

void SquarePainter::compose(const Box& tile, const std::vector<SquareFigure>& tags) {
  const Box area = tile.grown(optics_.margin());
  const int factor = optics_.factor();
  fine_.assign(static_cast<std::size_t>(area.width() * factor) *
                   static_cast<std::size_t>(area.height() * factor),
               floor_);
  for (const Figure& figure : clutter_) {
    if (!figure.visible()) continue;
    paint_figure(figure.box(), area, figure.base_light(), [&](const FineFrame& frame) {
      figure.draw(experiment_.camera, frame, base_, print_);
    });
  }
  for (const SquareFigure& tag : tags) {
    paint_figure(tag.box(), area, white_, [&](const FineFrame& frame) {
      tag.draw(frame, static_cast<double>(ink_), base_, print_);
    });
  }
  optics_.filter(fine_, tile.width(), tile.height(), pixels_);
  for (int v = tile.top; v < tile.bottom; ++v) {
    response_.encode(pixels_.data() + static_cast<std::ptrdiff_t>(v - tile.top) * tile.width(),
                     grey_.data() + static_cast<std::ptrdiff_t>(v) * image_.right + tile.left,
                     tile.width());
  }
}

template <typename Draw>
void SquarePainter::paint_figure(const Box& figure_box, const Box& area, float base_light,
                                 Draw&& draw) {
  const Box window = figure_box.intersection(area);
  if (window.empty()) return;
  const int factor = optics_.factor();
  const int width = window.width() * factor, height = window.height() * factor;
  base_.reset(width, height);
  print_.reset(width, height);
  draw(FineFrame{window.left, window.top, factor});

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
      cells[i] += covered * (base_light - cells[i]) + printed;
    }
  }
}

}  // namespace roundel::bench
