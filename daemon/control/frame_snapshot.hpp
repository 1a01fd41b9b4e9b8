#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/arena_calibration.hpp"
#include "calibration/arena_map.hpp"
#include "core/arena_pose.hpp"
#include "core/grey_image.hpp"
#include "core/marker.hpp"
#include "transport/messages.hpp"

namespace roundel {

// What poses are computed with; it changes with the configuration, the camera and the calibration,
// not from frame to frame.
struct TrackingContext {
  std::string camera_name;
  std::optional<CameraModel> camera;
  double diameter_m = 0;
  ArenaCamera arena_camera;  // what a calibration made now would belong to
  ArenaMode mode = ArenaMode::k2D;
  std::shared_ptr<const ArenaCalibration> calibration;  // the one on file; nullptr: none
  std::string problem;  // why it is not used; empty: it is, or there is none
  std::string arena_file;
  bool recalibrate = false;

  bool arena_in_use() const { return calibration && problem.empty(); }
};

// A frame as it is handed from the loop to everyone else.
struct FrameSnapshot {
  FrameInformation information;
  std::vector<Marker> markers;
  std::vector<ArenaPose> arena;  // of the markers; empty without an arena
  std::shared_ptr<const TrackingContext> context;
  bool has_picture = false;
  GreyImage picture;
};

}  // namespace roundel
