#pragma once

#include <cstdint>
#include <vector>

#include "core/marker.hpp"
#include "transport/frame_information.hpp"

namespace roundel {

// A marker whose every field differs from every other's, and from those of other indices.
inline Marker sample_marker(int index) {
  Marker marker;
  marker.id = index + 1;
  marker.id_probability = 0.95;
  marker.track = 100 + index;
  marker.u = 10.25 + index;
  marker.v = 20.5 + index;
  marker.ellipse = {11.0 + index, 21.0 + index, 19.75, 19.5, 0.25};
  marker.has_pose = true;
  marker.pose.position = {0.125 + index, -0.25, 3.0};
  marker.pose.orientation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  marker.sigma_position = {0.0009765625, 0.001953125, 0.00390625};
  marker.sigma_rotation = {0.0078125, 0.015625, 0.03125};
  marker.ambiguity = 0.0625;
  marker.has_alternative = true;
  marker.alternative.position = {0.5, 0.75, 3.25};
  marker.alternative.orientation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  return marker;
}

inline std::vector<Marker> sample_markers(int count) {
  std::vector<Marker> markers;
  for (int i = 0; i < count; ++i) markers.push_back(sample_marker(i));
  return markers;
}

inline FrameInformation sample_information(std::int64_t frame = 7) {
  FrameInformation information;
  information.session = 1'700'000'000'000'000;
  information.frame = frame;
  information.dropped = 0;
  information.captured = {1'700'000'001'000'000, 5'000'000};
  information.published = {1'700'000'001'020'000, 5'020'000};
  information.tracking_us = 31.5;
  information.width = 1920;
  information.height = 1080;
  information.stamp_source = StampSource::kMiddleOfExposure;
  information.clock = ClockState::kSynchronised;
  information.camera = CameraState::kStreaming;
  information.calibration = CalibrationState::kValid;
  information.arena = ArenaState::kNone;
  information.simulated = true;
  return information;
}

// The bytes of messages, kept.
using Message = std::vector<std::uint8_t>;

template <typename Parts>
std::vector<Message> copied(const Parts& parts) {
  std::vector<Message> messages;
  for (const auto& part : parts) messages.emplace_back(part.begin(), part.end());
  return messages;
}

}  // namespace roundel
