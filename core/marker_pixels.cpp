#include "core/marker_pixels.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/ellipse_rows.hpp"
#include "core/marker_geometry.hpp"
#include "core/rounding.hpp"

namespace roundel {

namespace {

constexpr double kInnerLimit = 0.8;  // pixels inside see the inner edges, outside the outer rim
constexpr double kMaxOutside = 0.2;  // of the radius: inside the white margin
constexpr int kMaxPixels = 6000;     // larger markers are thinned out
constexpr int kChunk = 16;           // pixels that are copied at once

}  // namespace

struct MarkerPixels::Row {
  const std::uint8_t* luma;  // of pixel u = 0
  std::ptrdiff_t pixel_stride;
  double centre_u;
  float dv;   // of the row, from the marker's middle
  int width;  // pixels
};

// Room for so many more, the last block's filling and what a chunk overwrites.
void MarkerPixels::Columns::make_room(int more) {
  const int total = used + more + kPixelBlock + 2 * kChunk;
  const auto needed = static_cast<std::size_t>(total);
  if (x.size() >= needed) return;
  for (auto* column : {&x, &y, &grey, &weight}) column->resize(2 * needed);
  luma.resize(2 * needed);
}

// From offsets and luma to what the fit wants, the last block filled up.
void MarkerPixels::Columns::finish(const LensPatch& patch, const ResponseCurve& response) {
  if (used == 0) return;
  make_room(kPixelBlock);
  const auto count = static_cast<std::size_t>(used), last = count - 1;
  std::size_t filled = count;
  for (; filled % kPixelBlock != 0; ++filled) {
    x[filled] = x[last];
    y[filled] = y[last];
    luma[filled] = luma[last];
  }
  response.undo(luma.data(), filled, grey.data(), weight.data());
  std::fill(weight.begin() + static_cast<std::ptrdiff_t>(count),
            weight.begin() + static_cast<std::ptrdiff_t>(filled), 0.0F);
  remove_lens(patch.cubic(), x.data(), y.data(), static_cast<int>(filled));
}

PixelColumns MarkerPixels::Columns::view() const {
  const int filled = (used + kPixelBlock - 1) / kPixelBlock * kPixelBlock;
  return {x.data(), y.data(), grey.data(), weight.data(), filled};
}

void MarkerPixels::take(const Row& row, int u0, int u1, int stride, Columns& columns) {
  if (u1 < u0) return;
  const int count = stride == 1 ? u1 - u0 + 1 : (u1 - u0) / stride + 1;
  const auto start = static_cast<std::size_t>(columns.used);
  columns.used += count;
  // By chunks that overwrite the room behind: most spans are shorter than one. Vectors of four are
  // what every processor has.
  using Float4 = float __attribute__((vector_size(16)));
  const auto between = static_cast<float>(stride);
  const auto first = static_cast<float>(u0 - row.centre_u);
  Float4 du = first + Float4{0, 1, 2, 3} * between;
  const Float4 dv = Float4{} + row.dv;
  float* x = columns.x.data() + start;
  float* y = columns.y.data() + start;
  for (int i = 0; i < count; i += kChunk) {
    for (int quarter = 0; quarter < kChunk; quarter += 4) {
      __builtin_memcpy(x + i + quarter, &du, sizeof du);
      __builtin_memcpy(y + i + quarter, &dv, sizeof dv);
      du += 4 * between;
    }
  }
  const std::uint8_t* from = row.luma + u0 * row.pixel_stride;
  const std::ptrdiff_t step = stride * row.pixel_stride;
  std::uint8_t* to = columns.luma.data() + start;
  if (step == 1 && u0 + (count + kChunk - 1) / kChunk * kChunk <= row.width) {
    // While the chunks stay within the row.
    for (int i = 0; i < count; i += kChunk) __builtin_memcpy(to + i, from + i, kChunk);
  } else {
    for (int i = 0; i < count; ++i, from += step) to[i] = *from;
  }
}

bool MarkerPixels::load(const LumaView& frame, const CameraModel& camera,
                        const ResponseCurve& response, const Ellipse& ellipse, double reach_px,
                        const InnerEdges& inner) {
  const double outside = std::min(kMaxOutside * ellipse.b, reach_px);
  const double a = ellipse.a + outside, b = ellipse.b + outside;
  const double cosine = std::cos(ellipse.angle), sine = std::sin(ellipse.angle);
  const double half_u = std::hypot(a * cosine, b * sine), half_v = std::hypot(a * sine, b * cosine);
  const auto patch = LensPatch::make(camera, {ellipse.u, ellipse.v}, std::max(half_u, half_v));
  if (!patch) return false;
  centre_ = {ellipse.u, ellipse.v};
  middle_ = patch->normalise(0, 0);
  pixel_slope_ = patch->slope();

  const int v0 = std::max(0, ceil_int(ellipse.v - half_v));
  const int v1 = std::min(frame.height - 1, floor_int(ellipse.v + half_v));
  const double area = std::numbers::pi * a * b;
  const int stride = std::max(1, static_cast<int>(std::lround(std::sqrt(area / kMaxPixels))));
  // Bands around the edges, in shares of the outline's radius.
  const double reach = reach_px / ellipse.b;
  const double rim_low = std::max(kInnerLimit, 1 - reach), rim_high = 1 + outside / ellipse.b;
  const double inner_low = std::max(0.0, inner.low - reach);
  const double inner_high = std::min(kInnerLimit, inner.high + reach);

  const EllipseRows rows(ellipse);
  outer_.used = inner_.used = 0;
  const int last_u = frame.width - 1;
  for (int v = v0; v <= v1; v += stride) {
    const double dv = v - ellipse.v;
    const Row row{frame.row(v), frame.pixel_stride, ellipse.u, static_cast<float>(dv), frame.width};
    const auto spans = rows.inside(dv, std::array{rim_high, rim_low, inner_high, inner_low});
    const auto take_band = [&](const EllipseRows::Span& whole, const EllipseRows::Span& hole,
                               Columns& columns) {
      if (whole.u1 < whole.u0) return;
      const int first = std::max(0, ceil_int(whole.u0));
      const int last = std::min(last_u, floor_int(whole.u1));
      columns.make_room(std::max(0, last - first) / stride + 1);
      if (hole.u1 < hole.u0) {
        take(row, first, last, stride, columns);
        return;
      }
      const int before = std::min(last, floor_int(hole.u0));
      const int after = std::max(first, ceil_int(hole.u1));
      take(row, first, before, stride, columns);
      take(row, std::max(after, before + 1), last, stride, columns);
    };
    take_band(spans[0], spans[1], outer_);
    take_band(spans[2], spans[3], inner_);
  }
  if (outer_.used < 2 * kPhotometricUnknowns || inner_.used == 0) return false;
  outer_.finish(*patch, response);
  inner_.finish(*patch, response);
  return true;
}

void MarkerPixels::relight(const ShadowEdge& edge) {
  relight(edge, outer_);
  relight(edge, inner_);
}

// Along the edge's normal a pixel lies as far as its place in the plane says: the lens is as good
// as linear over a marker.
void MarkerPixels::relight(const ShadowEdge& edge, Columns& columns) const {
  const Eigen::Vector2d along = pixel_slope_.transpose().inverse() * edge.into_shadow;
  const double at_centre = edge.into_shadow.dot(centre_);
  for (std::size_t i = 0; i < static_cast<std::size_t>(columns.used); ++i) {
    const double d = at_centre + along.x() * static_cast<double>(columns.x[i]) +
                     along.y() * static_cast<double>(columns.y[i]);
    if (d >= edge.shaded_from) {
      columns.grey[i] /= static_cast<float>(edge.light);
      columns.weight[i] *= static_cast<float>(edge.light);  // as its noise
    } else if (d > edge.lit_to) {
      columns.weight[i] = 0;
    }
  }
}

}  // namespace roundel
