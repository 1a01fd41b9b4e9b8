#include "bench/accuracy/distractors.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <utility>

#include "simulator/arena_camera.hpp"
#include "simulator/clutter.hpp"
#include "simulator/noise.hpp"
#include "simulator/random.hpp"
#include "simulator/renderer.hpp"

namespace roundel::bench {

namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kTurn = 2 * std::numbers::pi;

struct DestroyCairo {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroyCairo>;
using Context = std::unique_ptr<cairo_t, DestroyCairo>;

void set_grey(cairo_t* c, double grey) {
  cairo_set_source_rgb(c, grey, grey, grey);
}

// A place, turned and seen at up to 60 degrees, with one pixel as the unit.
void go_somewhere(cairo_t* c, Random& random) {
  const double u = random.uniform(0, kWidth), v = random.uniform(0, kHeight);
  cairo_translate(c, u, v);
  cairo_rotate(c, random.uniform(0, kTurn));
  cairo_scale(c, 1, random.uniform(0.5, 1));
  cairo_rotate(c, random.uniform(0, kTurn));
}

void text(cairo_t* c, Random& random) {
  static constexpr const char* kFaces[] = {"sans", "serif", "monospace"};
  for (int line = 0; line < 30; ++line) {
    cairo_save(c);
    go_somewhere(c, random);
    cairo_select_font_face(
        c, kFaces[random.below(3)], CAIRO_FONT_SLANT_NORMAL,
        random.below(2) == 0 ? CAIRO_FONT_WEIGHT_NORMAL : CAIRO_FONT_WEIGHT_BOLD);
    cairo_set_font_size(c, 8 * std::pow(20, random.uniform()));
    std::string word;
    for (int i = 0; i < 10; ++i) word += static_cast<char>('!' + random.below('~' - '!' + 1));
    set_grey(c, random.uniform(0, 0.3));
    cairo_show_text(c, word.c_str());
    cairo_restore(c);
  }
}

void disc(cairo_t* c, double radius, double grey) {
  set_grey(c, grey);
  cairo_arc(c, 0, 0, radius, 0, kTurn);
  cairo_fill(c);
}

void discs(cairo_t* c, Random& random) {
  for (int i = 0; i < 60; ++i) {
    cairo_save(c);
    go_somewhere(c, random);
    disc(c, 4 * std::pow(20, random.uniform()), random.uniform());
    cairo_restore(c);
  }
}

void rings(cairo_t* c, Random& random) {
  for (int i = 0; i < 25; ++i) {
    cairo_save(c);
    go_somewhere(c, random);
    double radius = 6 * std::pow(15, random.uniform());
    const double dark = random.uniform(0, 0.3), bright = random.uniform(0.7, 1);
    disc(c, 1.3 * radius, bright);
    const int count = 1 + static_cast<int>(random.below(3));
    for (int k = 0; k < count; ++k) {
      disc(c, radius, dark);
      radius *= random.below(2) == 0 ? random.uniform(0.1, 0.25) : random.uniform(0.70, 0.95);
      disc(c, radius, bright);
      radius *= random.uniform(0.5, 0.9);
    }
    // What is inside of several rings is dark: a bright middle in a dark ring would be a marker.
    if (count > 1) disc(c, radius, dark);
    cairo_restore(c);
  }
}

void checkerboard(cairo_t* c, Random& random) {
  go_somewhere(c, random);
  const double cell = 6 * std::pow(12, random.uniform());
  const double dark = random.uniform(0, 0.3);
  for (int row = -12; row < 12; ++row) {
    for (int column = -12; column < 12; ++column) {
      if ((row + column) % 2 != 0) continue;
      set_grey(c, dark);
      cairo_rectangle(c, column * cell, row * cell, cell, cell);
      cairo_fill(c);
    }
  }
}

void blots(cairo_t* c, Random& random) {
  for (int i = 0; i < 150; ++i) {
    cairo_save(c);
    go_somewhere(c, random);
    const double radius = 10 * std::pow(15, random.uniform()), grey = random.uniform();
    cairo_pattern_t* pattern = cairo_pattern_create_radial(0, 0, 0, 0, 0, radius);
    cairo_pattern_add_color_stop_rgba(pattern, 0, grey, grey, grey, random.uniform());
    cairo_pattern_add_color_stop_rgba(pattern, 1, grey, grey, grey, 0);
    cairo_set_source(c, pattern);
    cairo_paint(c);
    cairo_pattern_destroy(pattern);
    cairo_restore(c);
  }
}

std::vector<std::string> debian_pictures() {
  std::vector<std::string> files;
  for (const char* folder :
       {"/usr/share/icons", "/usr/share/pixmaps", "/usr/share/backgrounds", "/usr/share/doc"}) {
    std::error_code error;
    std::filesystem::recursive_directory_iterator entries(
        folder, std::filesystem::directory_options::skip_permission_denied, error);
    for (; !error && entries != end(entries); entries.increment(error)) {
      if (entries->path().extension() == ".png" && entries->is_regular_file(error)) {
        files.push_back(entries->path());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

using Drawer = std::function<void(cairo_t*, Random&)>;

class Drawn final : public Distractor {
 public:
  Drawn(std::string name, Drawer drawer) : name_(std::move(name)), drawer_(std::move(drawer)) {
    camera_.width = kWidth;
    camera_.height = kHeight;
    camera_.fx = camera_.fy = 600;
    camera_.cx = 0.5 * (kWidth - 1);
    camera_.cy = 0.5 * (kHeight - 1);
    for (const double sigma : {0, 3, 10}) noises_.emplace_back(sigma, kWidth);
  }
  const std::string& name() const override { return name_; }
  const CameraModel& camera() const override { return camera_; }

  void draw(std::uint64_t number, GreyImage& out) override {
    Random random(derived_seed(60, number));
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, kWidth, kHeight));
    const Context context(cairo_create(surface.get()));
    set_grey(context.get(), random.uniform(0.3, 1));
    cairo_paint(context.get());
    drawer_(context.get(), random);
    cairo_surface_flush(surface.get());

    const NoiseTable& noise = noises_[random.below(static_cast<std::uint32_t>(noises_.size()))];
    const unsigned char* data = cairo_image_surface_get_data(surface.get());
    const int stride = cairo_image_surface_get_stride(surface.get());
    out.resize(kWidth, kHeight);
    std::vector<std::int16_t> row(kWidth);
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const unsigned char* p = data + v * stride + 4 * u;  // blue, green, red, unused
        row[static_cast<std::size_t>(u)] = static_cast<std::int16_t>(
            Response::kFixedOne * (29 * p[0] + 150 * p[1] + 77 * p[2]) / 256);
      }
      noise.apply(row.data(), out.pixels.data() + v * kWidth, kWidth, random.bits());
    }
  }

 private:
  std::string name_;
  Drawer drawer_;
  CameraModel camera_;
  std::vector<NoiseTable> noises_;
};

class ArenaFloor final : public Distractor {
 public:
  ArenaFloor() {
    options_.corners = false;
    in_camera_ = arena_in_ceiling_camera(options_);
    renderer_ = std::make_unique<Renderer>(arena_camera(options_, in_camera_), options_.imaging);
  }
  const std::string& name() const override { return name_; }
  const CameraModel& camera() const override { return renderer_->camera(); }
  void draw(std::uint64_t number, GreyImage& out) override {
    Scene scene;
    scene.clutter =
        arena_clutter(derived_seed(61, number), options_.length_m, options_.width_m, in_camera_);
    renderer_->render(scene, derived_seed(62, number), out);
  }

 private:
  std::string name_ = "arena clutter";
  ArenaOptions options_;
  Pose in_camera_;
  std::unique_ptr<Renderer> renderer_;
};

// Icons and pictures side by side, each at some size.
Drawer contact_sheet(std::vector<std::string> files) {
  return [files = std::move(files)](cairo_t* c, Random& random) {
    for (int i = 0; i < 40; ++i) {
      const std::string& file = files[random.below(static_cast<std::uint32_t>(files.size()))];
      const Surface picture(cairo_image_surface_create_from_png(file.c_str()));
      const double u = random.uniform(-20, kWidth), v = random.uniform(-20, kHeight);
      const double scale = 0.5 * std::pow(8, random.uniform());
      if (cairo_surface_status(picture.get()) != CAIRO_STATUS_SUCCESS) continue;
      cairo_save(c);
      cairo_translate(c, u, v);
      const int side = std::max(cairo_image_surface_get_width(picture.get()),
                                cairo_image_surface_get_height(picture.get()));
      const double fitting = std::min(scale, 1.0 * kHeight / std::max(1, side));
      cairo_scale(c, fitting, fitting);
      cairo_set_source_surface(c, picture.get(), 0, 0);
      cairo_paint(c);
      cairo_restore(c);
    }
  };
}

}  // namespace

std::vector<std::unique_ptr<Distractor>> all_distractors() {
  std::vector<std::unique_ptr<Distractor>> all;
  all.push_back(std::make_unique<ArenaFloor>());
  all.push_back(std::make_unique<Drawn>("text", text));
  all.push_back(std::make_unique<Drawn>("discs", discs));
  all.push_back(std::make_unique<Drawn>("rings", rings));
  all.push_back(std::make_unique<Drawn>("checkerboards", checkerboard));
  all.push_back(std::make_unique<Drawn>("blots", blots));
  if (auto files = debian_pictures(); !files.empty()) {
    const std::string name = std::to_string(files.size()) + " pictures of Debian's packages";
    all.push_back(std::make_unique<Drawn>(name, contact_sheet(std::move(files))));
  }
  return all;
}

}  // namespace roundel::bench
