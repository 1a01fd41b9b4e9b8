#include "calibration/camera_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "calibration/bounded_yaml.hpp"

namespace roundel {
namespace {

constexpr int kMaxSide = 65535;  // pixels; no sensor comes near
constexpr std::size_t kMaxNameLength = 200;

// One file being read: where errors are, and the look-up of keys under their known spellings.
class Reader {
 public:
  Reader(const YAML::Node& document, const std::string& file_name)
      : document_(document), file_name_(file_name) {
    if (!document_.IsMap()) {
      fail(document_, "",
           "is not a camera file; expected image_width, image_height, "
           "camera_matrix and distortion_coefficients");
    }
  }

  [[noreturn]] void fail(const YAML::Node& node, std::string_view key,
                         const std::string& what) const {
    const YAML::Mark mark = node.IsDefined() ? node.Mark() : YAML::Mark::null_mark();
    throw std::runtime_error(
        fmt::format("{}: {}{}{}", where(file_name_, mark), key, key.empty() ? "" : ": ", what));
  }

  // The first spelling that is present; an undefined node if none is.
  YAML::Node find(std::initializer_list<const char*> spellings) const {
    for (const char* spelling : spellings) {
      const YAML::Node node = document_[spelling];
      if (node.IsDefined() && !node.IsNull()) return node;
    }
    return YAML::Node(YAML::NodeType::Undefined);
  }

  int side(const char* key, std::initializer_list<const char*> spellings) const {
    const YAML::Node node = find(spellings);
    if (!node.IsDefined()) {
      fail(node, key, "is missing; intrinsics hold for one resolution, in pixels");
    }
    int value = 0;
    if (!node.IsScalar() || !YAML::convert<int>::decode(node, value) || value < 1 ||
        value > kMaxSide) {
      fail(node, key, fmt::format("must be a whole number of pixels from 1 to {}", kMaxSide));
    }
    return value;
  }

  // Numbers of a matrix {rows, cols, data: [...]} (ROS, and OpenCV's !!opencv-matrix) or of a plain
  // list.
  std::vector<double> numbers(const YAML::Node& node, std::string_view key) const {
    const YAML::Node data = node.IsMap() ? node["data"] : node;
    if (!data.IsDefined() || !data.IsSequence()) {
      fail(node, key, "must be a matrix with rows, cols and data: [numbers]");
    }
    std::vector<double> values;
    for (const YAML::Node& element : data) {
      double value = 0;
      if (!element.IsScalar() || !YAML::convert<double>::decode(element, value) ||
          !std::isfinite(value)) {
        fail(element, key, "data must be finite numbers");
      }
      values.push_back(value);
    }
    if (node.IsMap()) {
      const std::size_t expected = dimension(node, key, "rows") * dimension(node, key, "cols");
      if (expected != values.size()) {
        fail(
            data, key,
            fmt::format("data has {} numbers, but rows times cols is {}", values.size(), expected));
      }
    }
    return values;
  }

 private:
  std::size_t dimension(const YAML::Node& matrix, std::string_view key, const char* name) const {
    constexpr int kMaxDimension = 100;
    const YAML::Node node = matrix[name];
    int value = 0;
    if (!node.IsDefined() || !node.IsScalar() || !YAML::convert<int>::decode(node, value) ||
        value < 1 || value > kMaxDimension) {
      fail(node.IsDefined() ? node : matrix, key,
           fmt::format("{} must be a whole number from 1 to {}", name, kMaxDimension));
    }
    return static_cast<std::size_t>(value);
  }

  YAML::Node document_;
  std::string file_name_;
};

void read_intrinsics(const Reader& reader, CameraModel& camera) {
  constexpr std::string_view kKey = "camera_matrix";
  const YAML::Node node =
      reader.find({"camera_matrix", "Camera_Matrix", "cameraMatrix", "camera_Matrix", "K"});
  if (!node.IsDefined()) {
    reader.fail(node, kKey, "is missing; expected rows: 3, cols: 3, data: [fx, 0, cx, ...]");
  }
  const std::vector<double> k = reader.numbers(node, kKey);
  if (k.size() != 9) {
    reader.fail(node, kKey, fmt::format("must have 9 numbers (3 by 3), not {}", k.size()));
  }
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  if (!(camera.fx > 0) || !(camera.fy > 0)) {
    reader.fail(node, kKey, "focal lengths (the first and fifth number) must be positive");
  }
  if (k[1] != 0) reader.fail(node, kKey, "skew (the second number) must be 0");
  if (k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    reader.fail(node, kKey, "must read [fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  }
}

// Says which lens model a number of coefficients belongs to in OpenCV and ROS.
std::string_view model_of(std::size_t coefficients) {
  switch (coefficients) {
    case 8:
      return "rational_polynomial";
    case 12:
      return "thin prism";
    case 14:
      return "tilted sensor";
    default:
      return "unknown";
  }
}

void read_lens(const Reader& reader, CameraModel& camera) {
  constexpr std::string_view kWanted =
      "calibrate with plumb_bob (k1, k2, p1, p2 and optionally k3)";
  const YAML::Node model = reader.find({"distortion_model", "camera_model"});
  if (model.IsDefined()) {
    const std::string name = model.IsScalar() ? model.Scalar() : "";
    if (name != "plumb_bob" && name != "pinhole") {
      reader.fail(model, "distortion_model",
                  fmt::format("\"{}\" is not supported; {}", name, kWanted));
    }
  }
  const YAML::Node fisheye = reader.find({"fisheye_model"});
  if (fisheye.IsDefined() && fisheye.IsScalar() && fisheye.Scalar() != "0") {
    reader.fail(fisheye, "fisheye_model", fmt::format("fisheye is not supported; {}", kWanted));
  }

  constexpr std::string_view kKey = "distortion_coefficients";
  const YAML::Node node = reader.find(
      {"distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "dist_coeffs", "D"});
  if (!node.IsDefined()) {
    reader.fail(node, kKey, "is missing; five zeros stand for a lens without distortion");
  }
  const std::vector<double> d = reader.numbers(node, kKey);
  if (d.size() != 4 && d.size() != 5) {
    reader.fail(node, kKey,
                fmt::format("{} coefficients ({} model) are not supported; {}", d.size(),
                            model_of(d.size()), kWanted));
  }
  camera.distortion = {d[0], d[1], d[2], d[3], d.size() == 5 ? d[4] : 0.0};
}

std::string read_name(const Reader& reader) {
  const YAML::Node node = reader.find({"camera_name"});
  if (!node.IsDefined()) return {};
  if (!node.IsScalar() || node.Scalar().size() > kMaxNameLength) {
    reader.fail(node, "camera_name",
                fmt::format("must be text of at most {} characters", kMaxNameLength));
  }
  return node.Scalar();
}

}  // namespace

CameraFile parse_camera_file(const std::string& text, const std::string& file_name) {
  const Reader reader(parse_bounded_yaml(text, file_name), file_name);
  CameraFile file;
  file.camera.width = reader.side("image_width", {"image_width", "image_Width", "imageWidth"});
  file.camera.height = reader.side("image_height", {"image_height", "image_Height", "imageHeight"});
  file.name = read_name(reader);
  read_intrinsics(reader, file.camera);
  read_lens(reader, file.camera);
  return file;
}

CameraFile read_camera_file(const std::string& path) {
  return parse_camera_file(read_text_file(path), path);
}

void check_resolution(const CameraModel& camera, int width, int height,
                      const std::string& file_name) {
  if (camera.width == width && camera.height == height) return;
  throw std::runtime_error(fmt::format(
      "{}: calibrated at {}x{}, but the frames are {}x{}; use a calibration made at {}x{}, or "
      "frames of {}x{}",
      file_name, camera.width, camera.height, width, height, width, height, camera.width,
      camera.height));
}

}  // namespace roundel
