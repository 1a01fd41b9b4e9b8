#include "core/detector.hpp"

namespace roundel {

struct Detector::Impl {};

Detector::Detector(const DetectorParameters&, std::optional<CameraModel>) {}
Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;
std::span<const Marker> Detector::detect(const LumaView&) {
  return {};
}

}  // namespace roundel
