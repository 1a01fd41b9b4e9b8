#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

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

// Without a pose, everything that needs one is left out.
nlohmann::ordered_json marker_json(const Marker& marker);

nlohmann::ordered_json frame_json(const FrameInfo& info, std::span<const Marker> markers);

// The object in one line with its end. Bytes that are no UTF-8 (file names) are replaced.
std::string json_line(const nlohmann::ordered_json& json);

}  // namespace roundel
