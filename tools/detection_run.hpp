#pragma once

#include <functional>
#include <optional>
#include <span>

#include "core/camera_model.hpp"
#include "core/luma_view.hpp"
#include "core/marker.hpp"
#include "tools/detection_options.hpp"

namespace roundel {

// What finds markers in a frame; the span holds until the next call.
using FindMarkers = std::function<std::span<const Marker>(const LumaView&)>;

// Makes a FindMarkers of the options' parameters and the camera, if there is one.
using MakeFinder =
    std::function<FindMarkers(const DetectorParameters&, const std::optional<CameraModel>&)>;

enum class FrameSizes { kAny, kOneForAll };

// The whole of `detect` and `track`: reads the camera and the frames, finds, prints, annotates.
void run_detection(const DetectionOptions& options, FrameSizes sizes,
                   const MakeFinder& make_finder);

}  // namespace roundel
