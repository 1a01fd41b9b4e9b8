#include "transport/messages.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace roundel {
namespace {

template <typename Enum>
constexpr std::int8_t code(Enum value) {
  return static_cast<std::int8_t>(value);
}

static_assert(code(StampSource::kMiddleOfExposure) == header_t::STAMP_MIDDLE_OF_EXPOSURE);
static_assert(code(StampSource::kStartOfFrame) == header_t::STAMP_START_OF_FRAME);
static_assert(code(StampSource::kEndOfFrame) == header_t::STAMP_END_OF_FRAME);
static_assert(code(StampSource::kArrival) == header_t::STAMP_ARRIVAL);
static_assert(code(ClockState::kSynchronised) == header_t::CLOCK_SYNCHRONISED);
static_assert(code(ClockState::kFreeRunning) == header_t::CLOCK_FREE_RUNNING);
static_assert(code(CameraState::kStreaming) == header_t::CAMERA_STREAMING);
static_assert(code(CameraState::kLost) == header_t::CAMERA_LOST);
static_assert(code(CameraState::kEnded) == header_t::CAMERA_ENDED);
static_assert(code(CalibrationState::kValid) == header_t::CALIBRATION_VALID);
static_assert(code(CalibrationState::kOtherResolution) == header_t::CALIBRATION_OTHER_RESOLUTION);
static_assert(code(ArenaState::kValid) == header_t::ARENA_VALID);
static_assert(code(ArenaState::kOtherCamera) == header_t::ARENA_OTHER_CAMERA);
static_assert(code(ArenaState::kMoved) == header_t::ARENA_MOVED);
static_assert(code(ArenaModeCode::k2D) == header_t::ARENA_MODE_2D);
static_assert(code(ArenaModeCode::k3D) == header_t::ARENA_MODE_3D);

std::int16_t pixels(int side) {
  return static_cast<std::int16_t>(
      std::clamp<int>(side, 0, std::numeric_limits<std::int16_t>::max()));
}

void write(const Eigen::Vector3d& vector, float (&out)[3]) {
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(vector[i]);
}

void write(const Eigen::Quaterniond& q, float (&out)[4]) {
  out[0] = static_cast<float>(q.w());
  out[1] = static_cast<float>(q.x());
  out[2] = static_cast<float>(q.y());
  out[3] = static_cast<float>(q.z());
}

void write(const ArenaPose& arena, marker_t& message) {
  if (!arena.valid) return;
  message.has_arena = 1;
  message.arena_x = static_cast<float>(arena.position.x());
  message.arena_y = static_cast<float>(arena.position.y());
  message.arena_z = static_cast<float>(arena.position.z());
  message.arena_heading = static_cast<float>(arena.heading);
  write(arena.sigma_position, message.arena_sigma);
  message.arena_sigma_heading = static_cast<float>(arena.sigma_heading);
}

Eigen::Vector3d vector(const float (&in)[3]) {
  return {in[0], in[1], in[2]};
}

Eigen::Quaterniond quaternion(const float (&in)[4]) {
  return {in[0], in[1], in[2], in[3]};
}

}  // namespace

header_t to_message(const FrameInformation& information) {
  header_t header{};
  header.session = information.session;
  header.frame = information.frame;
  header.dropped = information.dropped;
  header.capture_utime = information.captured.wall_us;
  header.capture_mono = information.captured.mono_us;
  header.publish_utime = information.published.wall_us;
  header.publish_mono = information.published.mono_us;
  header.tracking_us = static_cast<float>(information.tracking_us);
  header.width = pixels(information.width);
  header.height = pixels(information.height);
  header.stamp_source = code(information.stamp_source);
  header.clock_state = code(information.clock);
  header.camera_state = code(information.camera);
  header.calibration_state = code(information.calibration);
  header.arena_state = code(information.arena);
  header.arena_mode = code(information.arena_mode);
  header.simulated = information.simulated ? 1 : 0;
  return header;
}

marker_t to_message(const Marker& marker, const ArenaPose& arena) {
  marker_t message{};
  message.id = marker.id;
  message.id_probability = static_cast<float>(marker.id_probability);
  message.track = marker.track;
  message.u = static_cast<float>(marker.u);
  message.v = static_cast<float>(marker.v);
  message.ellipse_u = static_cast<float>(marker.ellipse.u);
  message.ellipse_v = static_cast<float>(marker.ellipse.v);
  message.ellipse_a = static_cast<float>(marker.ellipse.a);
  message.ellipse_b = static_cast<float>(marker.ellipse.b);
  message.ellipse_angle = static_cast<float>(marker.ellipse.angle);
  if (!marker.has_pose) return message;
  write(arena, message);
  message.has_pose = 1;
  write(marker.pose.position, message.position);
  write(marker.pose.orientation, message.orientation);
  write(marker.sigma_position, message.sigma_position);
  write(marker.sigma_rotation, message.sigma_rotation);
  message.ambiguity = static_cast<float>(marker.ambiguity);
  if (!marker.has_alternative) return message;
  message.has_alternative = 1;
  write(marker.alternative.position, message.alternative_position);
  write(marker.alternative.orientation, message.alternative_orientation);
  return message;
}

Marker from_message(const marker_t& message) {
  Marker marker;
  marker.id = message.id;
  marker.id_probability = message.id_probability;
  marker.track = message.track;
  marker.u = message.u;
  marker.v = message.v;
  marker.ellipse = {message.ellipse_u, message.ellipse_v, message.ellipse_a, message.ellipse_b,
                    message.ellipse_angle};
  if (message.has_pose == 0) return marker;
  marker.has_pose = true;
  marker.pose = {vector(message.position), quaternion(message.orientation)};
  marker.sigma_position = vector(message.sigma_position);
  marker.sigma_rotation = vector(message.sigma_rotation);
  marker.ambiguity = message.ambiguity;
  if (message.has_alternative == 0) return marker;
  marker.has_alternative = true;
  marker.alternative = {vector(message.alternative_position),
                        quaternion(message.alternative_orientation)};
  return marker;
}

ArenaPose arena_from_message(const marker_t& message) {
  ArenaPose arena;
  if (message.has_arena == 0) return arena;
  arena.valid = true;
  arena.position = {message.arena_x, message.arena_y, message.arena_z};
  arena.heading = message.arena_heading;
  arena.sigma_position = vector(message.arena_sigma);
  arena.sigma_heading = message.arena_sigma_heading;
  return arena;
}

}  // namespace roundel
