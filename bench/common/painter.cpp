#include "bench/common/painter.hpp"

#include <utility>

#include "simulator/random.hpp"

namespace roundel::bench {

namespace {

constexpr int kTile = 160;  // pixels; keeps the fine grid in the cache

}  // namespace

Painter::Painter(const Experiment& experiment, Print print)
    : experiment_(experiment),
      print_(std::move(print)),
      image_{0, 0, experiment.camera.width, experiment.camera.height},
      composer_(experiment.camera, experiment.imaging, experiment.clutter),
      noise_(experiment.imaging.noise_sigma, experiment.camera.width) {
  grey_.resize(static_cast<std::size_t>(image_.width()) *
               static_cast<std::size_t>(image_.height()));
  for (int top = 0; top < image_.bottom; top += kTile) {
    for (int left = 0; left < image_.right; left += kTile) {
      compose(PixelRange{left, top, left + kTile, top + kTile}.intersection(image_), {});
    }
  }
  empty_ = grey_;
}

void Painter::paint(const View& view, GreyImage& out) {
  std::vector<Drawing> drawings;
  drawings.reserve(view.markers.size());
  for (const PlacedMarker& marker : view.markers) {
    drawings.push_back(print_(experiment_.imaging, composer_.response(), marker));
  }
  grey_ = empty_;
  // Where the surroundings of two markers overlap they are composed twice, with the same result.
  for (const Drawing& drawing : drawings) {
    const PixelRange reach = drawing.box.grown(composer_.margin()).intersection(image_);
    if (!reach.empty()) compose(reach, drawings);
  }

  out.resize(image_.right, image_.bottom);
  Random rows(view.noise_seed);
  for (int v = 0; v < out.height; ++v) {
    const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(v) * out.width;
    noise_.apply(grey_.data() + start, out.pixels.data() + start, out.width, rows.bits());
  }
}

void Painter::compose(const PixelRange& piece, std::span<const Drawing> drawings) {
  const std::vector<float>& light = composer_.compose(piece, drawings);
  for (int v = piece.top; v < piece.bottom; ++v) {
    composer_.response().encode(
        light.data() + static_cast<std::ptrdiff_t>(v - piece.top) * piece.width(),
        grey_.data() + static_cast<std::ptrdiff_t>(v) * image_.right + piece.left, piece.width());
  }
}

}  // namespace roundel::bench
