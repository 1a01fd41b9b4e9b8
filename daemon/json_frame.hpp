#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/arena_pose.hpp"
#include "core/marker.hpp"

namespace roundel {

// The JSON objects that other people's scripts read (DESIGN.md section 4): fields may be added,
// never renamed or dropped.
struct FrameInfo {
  std::string source;      // file or camera
  std::int64_t frame = 0;  // number in its stream, from 0
  std::int64_t utime = 0;  // microseconds since the epoch; for video, since its start; 0 unknown
  double elapsed_us = 0;   // of the detection alone
};

nlohmann::ordered_json vector_json(const Eigen::Vector3d& v);         // [x, y, z]
nlohmann::ordered_json quaternion_json(const Eigen::Quaterniond& q);  // [w, x, y, z]

// Without a pose, everything that needs one is left out; without a place in the arena, that.
nlohmann::ordered_json marker_json(const Marker& marker, const ArenaPose& arena = {});

// `arena` has one entry a marker, or none at all.
nlohmann::ordered_json frame_json(const FrameInfo& info, std::span<const Marker> markers,
                                  std::span<const ArenaPose> arena = {});

// What a program that reads the JSON of a frame gets out of it.
struct ReportedFrame {
  std::int64_t frame = 0;
  std::vector<Marker> markers;
};

// The inverse of frame_json() and of what other programs write in its form; of a marker, the pose
// (position with orientation), sigma, id_probability and track may be left out, ellipse and
// ambiguity are not read. Throws std::runtime_error that names the field that is missing or wrong.
ReportedFrame frame_from_json(const nlohmann::ordered_json& json);

// The object in one line with its end. Bytes that are no UTF-8 (file names) are replaced.
std::string json_line(const nlohmann::ordered_json& json);

}  // namespace roundel
