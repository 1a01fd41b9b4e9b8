#include "tools/track_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/marker_matching.hpp"

namespace roundel {
namespace {

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void judge_accuracy(const MarkerTruth& truth, const Marker& reported, MarkerStatistics& kind) {
  kind.image_px.add(std::hypot(reported.u - truth.u, reported.v - truth.v));
  if (!reported.has_pose) {
    return;
  }
  const Eigen::Vector3d error = reported.pose.position - truth.pose.position;
  kind.position_m.add(error.norm());
  const double normal_error = angle_between(reported.pose.normal(), truth.pose.normal());
  kind.normal_rad.add(normal_error);
  if (normal_error > TrackStatistics::kFlip) {
    ++kind.flips;
  }
  if (truth.kind == MarkerKind::WhyCode) {
    kind.orientation_rad.add(orientation_error(reported.pose.orientation, truth.pose.orientation));
  }
  kind.position_sigma.add(error, reported.sigma_position);
}

}  // namespace

void SigmaStatistics::add(const Eigen::Vector3d& error, const Eigen::Vector3d& sigma) {
  if (!(sigma.array() > 0).all()) {  // none was reported
    return;
  }
  ++count;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double normalised = error[axis] / sigma[axis];
    within_one[i] += std::abs(normalised) <= 1 ? 1 : 0;
    sum_of_squares[i] += normalised * normalised;
  }
}

void TrackStatistics::begin(const FrameTruth& truth) {
  if (frames_ == 0) {
    for (const MarkerTruth& marker : truth.markers) {
      markers_.push_back({.kind = marker.kind, .id = marker.id});
    }
  }
  const bool same = std::equal(truth.markers.begin(), truth.markers.end(), markers_.begin(),
                               markers_.end(), [](const MarkerTruth& now, const TrueMarker& first) {
                                 return now.kind == first.kind && now.id == first.id;
                               });
  if (!same) {
    throw std::invalid_argument("lists other markers, or in another order, than the first frame");
  }
  ++frames_;
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    if (truth.markers[i].visible && truth.markers[i].kind != MarkerKind::Disc) {
      ++markers_[i].visible;
      ++of(markers_[i].kind).visible;
    } else {
      markers_[i].track = 0;  // what comes back may have another number
    }
  }
}

void TrackStatistics::add_unanswered(const FrameTruth& truth) {
  begin(truth);
  ++unanswered_;
}

void TrackStatistics::add(const FrameTruth& truth, std::span<const Marker> reported) {
  begin(truth);
  const auto matches = match_markers(truth.markers, reported, within_px_);
  std::vector<bool> found(truth.markers.size());
  for (std::size_t k = 0; k < reported.size(); ++k) {
    const Marker& marker = reported[k];
    if (marker.track > 0) {
      ++tracks_[marker.track].frames;
    }
    if (!matches[k]) {
      ++not_in_truth_;
      not_in_truth_with_id_ += marker.id > 0 ? 1 : 0;
      continue;
    }
    const std::size_t index = *matches[k];
    const MarkerTruth& is = truth.markers[index];
    MarkerStatistics& kind = of(is.kind);
    found[index] = true;
    judge_id(is, marker, kind);
    judge_track(index, is.visible, marker.track);
    if (is.visible) {
      ++markers_[index].found;
      ++kind.found;
      judge_accuracy(is, marker, kind);
    } else {
      ++kind.found_obscured;
    }
  }
  bool complete = true;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const MarkerTruth& is = truth.markers[i];
    complete = complete && (found[i] || !is.visible || is.kind == MarkerKind::Disc);
  }
  complete_ += complete ? 1 : 0;
}

void TrackStatistics::judge_id(const MarkerTruth& truth, const Marker& reported,
                               MarkerStatistics& kind) {
  if (reported.id > 0 && reported.id != truth.id) {
    ++kind.wrong_ids;
    // Without tracks there are no first frames.
    if (reported.track == 0 || tracks_[reported.track].frames > kFirstFrames) {
      ++kind.late_wrong_ids;
    }
  }
  if (truth.visible && truth.kind == MarkerKind::WhyCode && reported.id < 1) {
    ++kind.missing_ids;
  }
}

void TrackStatistics::judge_track(std::size_t index, bool visible, std::int64_t track) {
  if (track == 0) {
    return;
  }
  std::optional<std::size_t>& of_track = tracks_[track].marker;
  std::int64_t& of_marker = markers_[index].track;
  const bool other_marker = of_track && *of_track != index;
  const bool other_track = visible && of_marker != 0 && of_marker != track;
  tracks_changed_marker_ += other_marker ? 1 : 0;
  markers_changed_track_ += other_track ? 1 : 0;
  swaps_ += other_marker || other_track ? 1 : 0;
  of_track = index;
  if (visible) {
    of_marker = track;
  }
}

std::optional<double> TrackStatistics::least_found_share() const {
  std::optional<double> least;
  for (const TrueMarker& marker : markers_) {
    if (marker.visible > 0) {
      const double share = static_cast<double>(marker.found) / static_cast<double>(marker.visible);
      least = std::min(least.value_or(1), share);
    }
  }
  return least;
}

}  // namespace roundel
