#include <fmt/format.h>

#include <array>
#include <span>
#include <stdexcept>

#include "calibration/atomic_file.hpp"
#include "calibration/camera_file.hpp"

namespace roundel {
namespace {

// The shortest decimal that reads back exactly, always with digits on both sides of a point: YAML
// 1.1 readers (PyYAML in ROS's Python tools) take 1e-05 for a string.
std::string number(double value) {
  std::string text = fmt::format("{:#}", value);
  const std::size_t point = text.find('.');
  if (point + 1 == text.size() || text[point + 1] == 'e') text.insert(point + 1, 1, '0');
  return text;
}

std::string matrix(const char* key, int rows, int cols, std::span<const double> values) {
  std::string text = fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [", key, rows, cols);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += ", ";
    text += number(values[i]);
  }
  return text + "]\n";
}

// A name is written as a plain word or in double quotes, so that any reader gets it back.
std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + "\"";
}

bool is_plain_word(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (name.empty() || !is_letter(name[0])) return false;
  for (const char c : name) {
    if (!is_letter(c) && !(c >= '0' && c <= '9') && c != '_' && c != '-') return false;
  }
  for (const char* word :
       {"null", "Null", "NULL", "true", "True", "TRUE", "false", "False", "FALSE",
        "yes",  "Yes",  "YES",  "no",   "No",   "NO",   "on",    "On",    "ON",
        "off",  "Off",  "OFF",  "y",    "Y",    "n",    "N"}) {
    if (name == word) return false;
  }
  return true;
}

}  // namespace

std::string format_camera_file(const CameraFile& file, std::span<const std::string> comments) {
  const CameraModel& c = file.camera;
  const auto& [k1, k2, p1, p2, k3] = c.distortion;
  for (const char ch : file.name) {
    if (static_cast<unsigned char>(ch) < 0x20) {
      throw std::runtime_error("camera_name: control characters can't be written to a camera file");
    }
  }
  const std::string name = is_plain_word(file.name) ? file.name : quoted(file.name);
  const std::array<double, 9> intrinsics = {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1};
  const std::array<double, 5> lens = {k1, k2, p1, p2, k3};
  const std::array<double, 9> rectification = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::array<double, 12> projection = {c.fx, 0, c.cx, 0, 0, c.fy, c.cy, 0, 0, 0, 1, 0};
  std::string text;
  for (const std::string& comment : comments) text += "# " + comment + "\n";
  return text +
         fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", c.width, c.height,
                     name) +
         matrix("camera_matrix", 3, 3, intrinsics) + "distortion_model: plumb_bob\n" +
         matrix("distortion_coefficients", 1, 5, lens) +
         matrix("rectification_matrix", 3, 3, rectification) +
         matrix("projection_matrix", 3, 4, projection);
}

void write_camera_file(const std::string& path, const CameraFile& file,
                       std::span<const std::string> comments) {
  write_file_atomically(path, format_camera_file(file, comments));
}

}  // namespace roundel
