#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/arena_map.hpp"
#include "config/configuration.hpp"
#include "core/arena_pose.hpp"
#include "daemon/control/frame_snapshot.hpp"
#include "transport/frame_information.hpp"

namespace roundel {

// The calibration in a file; nullptr if there is none. `problem` says why one that is there can't
// be read.
std::shared_ptr<const ArenaCalibration> load_arena(const std::string& path, std::string& problem);

// The stage of a frame between tracker and publisher: from the camera to the arena. A calibration
// that belongs to another camera, resolution, crop or lens is not used. No allocation in locate()
// once as many markers have been seen.
class ArenaStage {
 public:
  // Takes what it works with from now on; the context says why it can't, if so.
  void configure(std::shared_ptr<const TrackingContext> context, const MountSettings& mounts);
  void set_moved(bool moved) { moved_ = moved; }

  const std::shared_ptr<const TrackingContext>& context() const { return context_; }
  ArenaState state() const;
  ArenaModeCode mode() const;

  // Of each marker; empty without a calibration in use. Holds until the next call.
  std::span<const ArenaPose> locate(std::span<const Marker> markers);

 private:
  std::shared_ptr<const TrackingContext> context_;
  std::optional<ArenaMap> map_;
  bool moved_ = false;
  std::vector<ArenaPose> poses_;
};

}  // namespace roundel
