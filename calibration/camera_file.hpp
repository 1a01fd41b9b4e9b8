#pragma once

#include <span>
#include <string>

#include "core/camera_model.hpp"

namespace roundel {

// A camera's intrinsics as a file holds them.
struct CameraFile {
  std::string name;    // camera_name; empty where the file has none
  CameraModel camera;  // finite values, positive focal lengths, positive resolution
};

// Reads intrinsics from the YAML that ROS camera_calibration writes (camera_info), or from OpenCV's
// FileStorage YAML. Plumb bob with 4 or 5 coefficients; other lens models are refused by name.
// Throws std::runtime_error "file:line:column: key: what is wrong, and what would be right".
CameraFile read_camera_file(const std::string& path);
CameraFile parse_camera_file(const std::string& text, const std::string& file_name);

// The file's text as ROS camera_calibration_parsers and OpenCV-based tools read it: all its keys,
// with the rectification and projection of an unrectified camera. Numbers read back exactly. The
// comments stand above, a line each; readers pass over them.
std::string format_camera_file(const CameraFile& file, std::span<const std::string> comments = {});

// Writes it at once or not at all (atomic_file.hpp).
void write_camera_file(const std::string& path, const CameraFile& file,
                       std::span<const std::string> comments = {});

// Intrinsics hold for one resolution. Throws std::runtime_error that names the file and both
// resolutions unless the camera's is that of the frames.
void check_resolution(const CameraModel& camera, int width, int height,
                      const std::string& file_name);

}  // namespace roundel
