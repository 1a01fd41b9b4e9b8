#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/camera_model.hpp"
#include "core/detector_parameters.hpp"
#include "core/luma_view.hpp"
#include "core/marker.hpp"
#include "core/stage_times.hpp"
#include "core/workers.hpp"

namespace roundel {

// Follows markers through consecutive frames ([P] section 3, METHOD.md sections 1 and 5): a marker
// seen before is looked for where it is expected, newcomers are searched for at bounded cost, ids
// are held by the evidence of all frames of a track.
// Not thread-safe: one tracker, one thread. No allocation after the first frames of a kind.
class Tracker {
 public:
  // Throws std::invalid_argument for parameters out of range. Without a camera, markers have no
  // pose.
  Tracker(const DetectorParameters& parameters, std::optional<CameraModel> camera);
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  // Markers seen in this frame, by track number. The span holds until the next call.
  // The camera's resolution must be that of the frame, otherwise std::invalid_argument.
  std::span<const Marker> track(const LumaView& frame);

  // From now on many markers are followed by all these workers; what is found is the same.
  void share_work(std::shared_ptr<Workers> workers);

  // From now on the stages of every frame are timed by this clock; null: not at all.
  void time_stages(StageStopwatch::Clock clock);
  // Of the last frame; zero where they are not timed.
  const StageTimes& stage_times() const;

  // Forgets all tracks (after a cut in the stream). Track numbers go on rising.
  void reset();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roundel
