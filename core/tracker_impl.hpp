#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "core/marker_search.hpp"
#include "core/track.hpp"
#include "core/tracker.hpp"

namespace roundel {

// Of the same marker in neighbouring frames.
inline bool similar_size(const Ellipse& a, const Ellipse& b) {
  constexpr double kSameSize = 1.6;
  const double ratio = std::sqrt((a.a * a.b) / (b.a * b.b));
  return ratio < kSameSize && ratio > 1 / kSameSize;
}

// To find a marker where its motion leads, before others' claims are looked at.
struct Attempt {
  Ellipse expected;
  std::optional<Observation> seen;
};

struct Tracker::Impl {
  Impl(const DetectorParameters& p, const std::optional<CameraModel>& camera)
      : parameters(p), search(p), observer(p, camera) {
    const auto usual = static_cast<std::size_t>(std::min(p.max_markers, 1024));
    tracks.reserve(usual);
    found.reserve(usual);
    markers.reserve(usual);
    attempts.resize(1);
  }

  // tracker_follow.cpp: the tracks that were seen in the last frame.
  void follow_tracks(const LumaView& frame);
  bool only_fitted(const Track& track) const;
  bool in_new_light(const Track& track) const;
  std::optional<Observation> fit(const LumaView& frame, const Track& track,
                                 const Expectation& expected, int worker = 0);
  Attempt follow_closely(const LumaView& frame, const Track& track, int worker);
  bool follow_side_by_side(const LumaView& frame);
  bool accept(const Attempt& attempt, const LumaView& frame);
  bool follow(const LumaView& frame, const Track& track);
  Observation observe(const LumaView& frame, const Track& track);
  Attempt follow_disturbed(const LumaView& frame, const Track& track);
  void follow_with_care(const LumaView& frame, Track& track);

  // tracker.cpp: whatever else is in the picture, and what becomes of it.
  void search_for_lost(const LumaView& frame);
  void search_nearby(const LumaView& frame, const Track& track);
  void find_newcomers(const LumaView& frame);
  void exchange_mistaken();
  void adopt(const Observation& observation);
  Track* lost_track_for(const Observation& observation);
  void ask_for_curve(const LumaView& frame);
  void publish();

  DetectorParameters parameters;
  MarkerSearch search;
  Observer observer;
  std::vector<Track> tracks;  // by rising number
  std::vector<Segment> found;
  std::vector<Marker> markers;
  std::vector<Attempt> attempts;  // of all tracks where work is shared, else of one at a time
  std::shared_ptr<Workers> workers;
  std::int64_t next_number = 1;
  std::int64_t frames = 0;
  int askings = 0;             // of followed markers for the camera's curve, up to a limit
  std::int64_t undecided = 0;  // tracks whose pose was not sure at the frame's start
  int band = 0;                // the part of the image searched for newcomers in this frame
  StageStopwatch::Clock clock = nullptr;
  StageTimes stage_times;
};

}  // namespace roundel
