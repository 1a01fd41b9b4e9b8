#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/camera_model.hpp"
#include "core/detector_parameters.hpp"
#include "core/luma_view.hpp"
#include "core/marker.hpp"

namespace roundel {

// Finds markers in single frames, without any memory of earlier ones ([P] section 3).
// Not thread-safe: one detector, one thread. No allocation after the first frames of a kind.
class Detector {
 public:
  // Throws std::invalid_argument for parameters out of range. Without a camera, markers have no
  // pose.
  Detector(const DetectorParameters& parameters, std::optional<CameraModel> camera);
  ~Detector();
  Detector(Detector&&) noexcept;
  Detector& operator=(Detector&&) noexcept;

  // Markers of the frame, by rising row. The span holds until the next call.
  // The camera's resolution must be that of the frame, otherwise std::invalid_argument.
  std::span<const Marker> detect(const LumaView& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roundel
