#include "daemon/arena_stage.hpp"

#include "calibration/arena_file.hpp"
#include "config/mounts.hpp"

namespace roundel {

std::shared_ptr<const ArenaCalibration> load_arena(const std::string& path, std::string& problem) {
  problem.clear();
  try {
    if (auto calibration = ArenaStore(path).load()) {
      return std::make_shared<const ArenaCalibration>(std::move(*calibration));
    }
  } catch (const std::runtime_error& error) {
    problem = error.what();
  }
  return nullptr;
}

void ArenaStage::configure(std::shared_ptr<const TrackingContext> context,
                           const MountSettings& mounts) {
  const bool same_calibration = context_ && context_->calibration == context->calibration;
  if (!same_calibration) moved_ = false;
  context_ = std::move(context);
  map_.reset();
  if (context_->arena_in_use()) {
    map_.emplace(*context_->calibration, context_->mode, marker_mounts(mounts));
  }
}

ArenaState ArenaStage::state() const {
  if (!context_ || !context_->calibration) return ArenaState::kNone;
  if (!map_) return ArenaState::kOtherCamera;
  return moved_ ? ArenaState::kMoved : ArenaState::kValid;
}

ArenaModeCode ArenaStage::mode() const {
  if (!map_) return ArenaModeCode::kNone;
  return map_->mode() == ArenaMode::k2D ? ArenaModeCode::k2D : ArenaModeCode::k3D;
}

std::span<const ArenaPose> ArenaStage::locate(std::span<const Marker> markers) {
  poses_.clear();
  if (!map_) return poses_;
  for (const Marker& marker : markers) poses_.push_back(map_->locate(marker));
  return poses_;
}

}  // namespace roundel
