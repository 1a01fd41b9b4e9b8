#include "core/detector.hpp"

#include <algorithm>
#include <vector>

#include "core/frame_check.hpp"
#include "core/marker_search.hpp"
#include "core/observer.hpp"

namespace roundel {

struct Detector::Impl {
  Impl(const DetectorParameters& p, const std::optional<CameraModel>& camera)
      : parameters(p), search(p), observer(p, camera) {
    const auto usual = static_cast<std::size_t>(std::min(p.max_markers, 1024));
    segments.reserve(usual);
    markers.reserve(usual);
  }

  DetectorParameters parameters;
  MarkerSearch search;
  Observer observer;
  void observe(const LumaView& frame);

  std::vector<Segment> segments;
  std::vector<Marker> markers;
};

Detector::Detector(const DetectorParameters& parameters, std::optional<CameraModel> camera)
    : impl_(std::make_unique<Impl>(parameters, camera)) {}
Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;

void Detector::Impl::observe(const LumaView& frame) {
  markers.clear();
  for (const Segment& segment : segments) {
    const Observation observation = observer.observe(frame, segment);
    if (!observation.convincing) continue;
    Marker marker = observer.to_marker(observation, 0);
    if (observation.id_probability >= parameters.min_id_probability) {
      marker.id = observation.id;
      marker.id_probability = observation.id_probability;
    }
    markers.push_back(marker);
  }
}

std::span<const Marker> Detector::detect(const LumaView& frame) {
  check_frame(frame, impl_->observer.camera());
  impl_->segments.clear();
  impl_->markers.clear();
  impl_->search.begin(frame);
  impl_->search.search(frame, {0, 0, frame.width - 1, frame.height - 1},
                       impl_->search.smallest_spacing(),
                       static_cast<std::size_t>(impl_->parameters.max_markers), impl_->segments);
  // Where the markers tell that the camera's curve is another one, they are looked at again.
  constexpr int kRounds = 3;
  impl_->observer.forget_curve();
  impl_->observe(frame);
  for (int round = 1; round < kRounds && impl_->observer.settle_curve(); ++round) {
    impl_->observe(frame);
  }
  std::sort(impl_->markers.begin(), impl_->markers.end(),
            [](const Marker& a, const Marker& b) { return a.v != b.v ? a.v < b.v : a.u < b.u; });
  return impl_->markers;
}

}  // namespace roundel
