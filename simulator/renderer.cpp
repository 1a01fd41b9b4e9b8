#include "simulator/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "simulator/coverage.hpp"
#include "simulator/figure.hpp"
#include "simulator/light.hpp"
#include "simulator/noise.hpp"
#include "simulator/optics.hpp"
#include "simulator/random.hpp"
#include "simulator/response.hpp"

namespace roundel {

namespace {

constexpr int kTile = 160;  // pixels; bounds the scratch memory and keeps it in the cache

void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(message);
}

void check(const CameraModel& camera, const Imaging& imaging) {
  require(camera.width > 0 && camera.height > 0 && camera.width <= 16384 && camera.height <= 16384,
          "the camera's width and height must lie between 1 and 16384 pixels");
  require(camera.fx > 0 && camera.fy > 0, "the camera's focal lengths must be above 0");
  for (const double grey : {imaging.black, imaging.white, imaging.floor}) {
    require(grey >= 0 && grey <= 255, "black, white and floor must lie between 0 and 255");
  }
  require(imaging.gamma >= 0.2 && imaging.gamma <= 5, "gamma must lie between 0.2 and 5");
  require(imaging.exposure_s >= 0 && imaging.exposure_s <= 1,
          "exposure_s must lie between 0 and 1 s");
}

}  // namespace

struct Renderer::Impl {
  Impl(const CameraModel& the_camera, const Imaging& the_imaging)
      : camera(the_camera),
        imaging(the_imaging),
        image{0, 0, the_camera.width, the_camera.height},
        response(the_imaging.gamma, the_imaging.srgb),
        optics(the_imaging.blur_px),
        light(the_imaging, the_camera.width, the_camera.height),
        noise(the_imaging.noise_sigma, the_camera.width),
        grey(static_cast<std::size_t>(the_camera.width) *
             static_cast<std::size_t>(the_camera.height)) {}

  void collect(const Scene& scene);
  void find_changes();
  void note(const PixelRange& box);
  void compose(const PixelRange& box);
  void compose_tile(const PixelRange& tile);
  void paint(const Figure& figure, const PixelRange& area);
  PixelRange reach(const Figure& figure) const {
    return figure.box().grown(optics.margin()).intersection(image);
  }

  CameraModel camera;
  Imaging imaging;
  PixelRange image;
  Response response;
  Optics optics;
  Light light;
  NoiseTable noise;

  std::vector<Figure> figures, drawn;  // of this frame; of the one in `grey`
  bool first = true;
  std::vector<std::int16_t> grey;  // the picture without noise, in Response's fixed point
  std::vector<PixelRange> changes;

  std::vector<float> fine, pixels;  // of one tile
  CoverageGrid base, print;
};

Renderer::Renderer(const CameraModel& camera, const Imaging& imaging) {
  check(camera, imaging);
  impl_ = std::make_unique<Impl>(camera, imaging);
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const CameraModel& Renderer::camera() const {
  return impl_->camera;
}
const Imaging& Renderer::imaging() const {
  return impl_->imaging;
}

void Renderer::render(const Scene& scene, std::uint64_t noise_seed, GreyImage& out) {
  Impl& self = *impl_;
  self.collect(scene);
  self.find_changes();
  for (const PixelRange& box : self.changes) self.compose(box);
  std::swap(self.figures, self.drawn);
  self.first = false;

  out.resize(self.image.right, self.image.bottom);
  Random rows(noise_seed);
  for (int v = 0; v < out.height; ++v) {
    const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(v) * out.width;
    self.noise.apply(self.grey.data() + start, out.pixels.data() + start, out.width, rows.bits());
  }
}

void Renderer::Impl::collect(const Scene& scene) {
  figures.clear();
  for (const SceneShape& s : scene.clutter) figures.emplace_back(s, imaging, response, camera);
  for (const SceneMarker& m : scene.markers) figures.emplace_back(m, imaging, response, camera);
  for (const SceneShape& s : scene.occluders) figures.emplace_back(s, imaging, response, camera);
}

// What must be drawn again: where a figure was and where it is, if it is not the same as before.
void Renderer::Impl::find_changes() {
  changes.clear();
  if (first) {
    changes.push_back(image);
    return;
  }
  const std::size_t count = std::max(figures.size(), drawn.size());
  for (std::size_t i = 0; i < count; ++i) {
    const bool now = i < figures.size(), before = i < drawn.size();
    if (now && before && figures[i] == drawn[i]) continue;
    PixelRange old_box, new_box;
    if (before && drawn[i].visible()) old_box = reach(drawn[i]);
    if (now && figures[i].visible()) new_box = reach(figures[i]);
    if (!old_box.empty() && !new_box.empty() && !old_box.intersection(new_box).empty()) {
      note(old_box.hull(new_box));
    } else {
      note(old_box);
      note(new_box);
    }
  }
}

// Joins a change with one noted before where that saves work; overlaps that stay are drawn twice.
void Renderer::Impl::note(const PixelRange& box) {
  if (box.empty()) return;
  const auto area = [](const PixelRange& b) { return static_cast<double>(b.width()) * b.height(); };
  for (PixelRange& other : changes) {
    const PixelRange joined = other.hull(box);
    if (area(joined) <= area(other) + area(box)) {
      other = joined;
      return;
    }
  }
  changes.push_back(box);
}

void Renderer::Impl::compose(const PixelRange& box) {
  for (int top = box.top; top < box.bottom; top += kTile) {
    for (int left = box.left; left < box.right; left += kTile) {
      compose_tile(PixelRange{left, top, left + kTile, top + kTile}.intersection(box));
    }
  }
}

void Renderer::Impl::compose_tile(const PixelRange& tile) {
  const PixelRange area = tile.grown(optics.margin());  // the scene that the tile's pixels see
  const int factor = optics.factor();
  fine.assign(static_cast<std::size_t>(area.width() * factor) *
                  static_cast<std::size_t>(area.height() * factor),
              static_cast<float>(response.light_of_grey(imaging.floor)));
  for (const Figure& figure : figures) {
    if (figure.visible() && !figure.box().intersection(area).empty()) paint(figure, area);
  }
  light.apply(fine, {area.left, area.top, factor}, area.width() * factor, area.height() * factor);
  optics.filter(fine, tile.width(), tile.height(), pixels);
  for (int v = tile.top; v < tile.bottom; ++v) {
    response.encode(pixels.data() + static_cast<std::ptrdiff_t>(v - tile.top) * tile.width(),
                    grey.data() + static_cast<std::ptrdiff_t>(v) * image.right + tile.left,
                    tile.width());
  }
}

void Renderer::Impl::paint(const Figure& figure, const PixelRange& area) {
  const int factor = optics.factor();
  const PixelRange window = figure.box().intersection(area);
  const int width = window.width() * factor, height = window.height() * factor;
  base.reset(width, height);
  print.reset(width, height);
  figure.draw(camera, {window.left, window.top, factor}, base, print);

  const float base_light = figure.base_light();
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(area.width()) * factor;
  float* corner = fine.data() + (window.top - area.top) * factor * stride +
                  static_cast<std::ptrdiff_t>(window.left - area.left) * factor;
  for (int j = 0; j < height; ++j) {
    const float* base_row = base.row(j);
    const float* print_row = print.row(j);
    float* cells = corner + j * stride;
    float covered = 0, printed = 0;
    for (int i = 0; i < width; ++i) {
      covered += base_row[i];
      printed += print_row[i];
      cells[i] += covered * (base_light - cells[i]) + printed;
    }
  }
}

}  // namespace roundel
