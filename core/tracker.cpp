#include "core/tracker.hpp"

namespace roundel {

struct Tracker::Impl {};

Tracker::Tracker(const DetectorParameters&, std::optional<CameraModel>) {}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;
std::span<const Marker> Tracker::track(const LumaView&) {
  return {};
}

void Tracker::reset() {}

}  // namespace roundel
