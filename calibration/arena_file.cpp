#include "calibration/arena_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "calibration/arena_calibrator.hpp"
#include "calibration/bounded_yaml.hpp"

namespace roundel {
namespace {

constexpr int kFormat = 1;
constexpr std::array kOrigins = {"bottom-left", "bottom-right", "top-right", "top-left"};
constexpr double kFar = 1e6;  // no number of a calibration comes near

// YAML's double-quoted style takes what JSON's does.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (code < 0x20 || code == 0x7f) {
      result += fmt::format("\\x{:02x}", static_cast<unsigned>(code));
    } else {
      result += c;
    }
  }
  return result + '"';
}

template <typename Values>
std::string list(const Values& values) {
  return fmt::format("[{}]", fmt::join(values.begin(), values.end(), ", "));
}

// One file being read: typed values of keys, and where errors are.
class Reader {
 public:
  Reader(const YAML::Node& node, std::string name) : node_(node), name_(std::move(name)) {
    if (!node_.IsMap()) fail(node_, "is not an arena calibration");
  }

  [[noreturn]] void fail(const YAML::Node& at, const std::string& what) const {
    throw std::runtime_error(fmt::format(
        "{}: {}", where(name_, at.IsDefined() ? at.Mark() : YAML::Mark::null_mark()), what));
  }

  YAML::Node at(const char* key) const {
    const YAML::Node node = node_[key];
    if (!node.IsDefined()) fail(node_, fmt::format("{} is missing", key));
    return node;
  }
  Reader section(const char* key) const {
    const YAML::Node node = at(key);
    if (!node.IsMap()) fail(node, fmt::format("{} must be a section", key));
    return {node, name_};
  }
  std::vector<Reader> sections(const char* key, std::size_t most) const {
    const YAML::Node node = at(key);
    if (!node.IsSequence() || node.size() > most) {
      fail(node, fmt::format("{} must be a list of at most {}", key, most));
    }
    std::vector<Reader> result;
    for (const YAML::Node& element : node) result.emplace_back(element, name_);
    return result;
  }

  double number(const char* key, double least = -kFar, double most = kFar) const {
    return number(at(key), key, least, most);
  }
  int whole(const char* key, int least, int most) const {
    const double value = number(key, least, most);
    if (value != std::floor(value)) fail(at(key), fmt::format("{} must be a whole number", key));
    return static_cast<int>(value);
  }
  std::string text(const char* key, std::size_t longest) const {
    const YAML::Node node = at(key);
    if (!node.IsScalar() || node.Scalar().size() > longest) {
      fail(node, fmt::format("{} must be text of at most {} characters", key, longest));
    }
    return node.Scalar();
  }
  std::vector<double> numbers(const char* key, std::size_t least, std::size_t most) const {
    const YAML::Node node = at(key);
    if (!node.IsSequence() || node.size() < least || node.size() > most) {
      fail(node, least == most ? fmt::format("{} must be a list of {} numbers", key, most)
                               : fmt::format("{} must be a list of numbers", key));
    }
    std::vector<double> values;
    for (const YAML::Node& element : node) values.push_back(number(element, key, -kFar, kFar));
    return values;
  }
  std::vector<double> numbers(const char* key, std::size_t count) const {
    return numbers(key, count, count);
  }

 private:
  double number(const YAML::Node& node, const char* key, double least, double most) const {
    double value = 0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !(value >= least) ||
        !(value <= most)) {
      fail(node, fmt::format("{} must be a number from {:g} to {:g}", key, least, most));
    }
    return value;
  }

  YAML::Node node_;
  std::string name_;
};

ArenaCamera read_camera(const Reader& file) {
  constexpr int kMaxSide = 65535;
  constexpr std::size_t kLongest = 1000;
  ArenaCamera camera;
  camera.identity = file.text("identity", kLongest);
  camera.crop = file.text("crop", kLongest);
  CameraModel& lens = camera.intrinsics;
  lens.width = file.whole("width", 1, kMaxSide);
  lens.height = file.whole("height", 1, kMaxSide);
  lens.fx = file.number("fx", 1e-3);
  lens.fy = file.number("fy", 1e-3);
  lens.cx = file.number("cx");
  lens.cy = file.number("cy");
  const std::vector<double> d = file.numbers("distortion", 5);
  lens.distortion = {d[0], d[1], d[2], d[3], d[4]};
  return camera;
}

ArenaRequest read_request(const Reader& file) {
  constexpr int kMaxId = 65535;
  ArenaRequest request;
  request.width_m = file.number("width");
  request.height_m = file.number("height");
  const auto origin = origin_of(file.text("origin", 20));
  if (!origin) {
    file.fail(file.at("origin"),
              fmt::format("origin must be one of {}", fmt::join(kOrigins, ", ")));
  }
  request.origin = *origin;
  for (const double id : file.numbers("ids", 0, 4)) request.ids.push_back(static_cast<int>(id));
  for (const Reader& anchor : file.sections("anchors", 100)) {
    request.anchors.push_back(
        {anchor.whole("id", 1, kMaxId), anchor.number("x"), anchor.number("y")});
  }
  request.corner_height_m = file.number("corner_height");
  request.corner_diameter_m = file.number("corner_diameter");
  request.certainty_m = file.number("certainty");
  request.time_limit_s = file.number("time_limit");
  request.tolerance_m = file.number("tolerance");
  try {
    check(request);
  } catch (const std::invalid_argument& error) {
    file.fail(file.at("width"), error.what());
  }
  return request;
}

Pose read_pose(const Reader& file) {
  constexpr double kUnit = 1e-6;
  const std::vector<double> p = file.numbers("position", 3), q = file.numbers("orientation", 4);
  Pose pose;
  pose.position = {p[0], p[1], p[2]};
  pose.orientation = {q[0], q[1], q[2], q[3]};
  if (!(std::abs(pose.orientation.norm() - 1) < kUnit)) {
    file.fail(file.at("orientation"), "orientation must be a unit quaternion, [w, x, y, z]");
  }
  if (!(pose.normal().dot(pose.position) < 0)) {
    file.fail(file.at("position"), "the camera must be above the floor");
  }
  return pose;
}

void read_result(const Reader& file, ArenaCalibration& calibration) {
  calibration.arena_in_camera = read_pose(file);
  const std::vector<double> c = file.numbers("covariance", 36);
  for (Eigen::Index i = 0; i < 36; ++i) {
    calibration.covariance(i / 6, i % 6) = c[static_cast<std::size_t>(i)];
  }
  if (!(calibration.covariance.diagonal().minCoeff() >= 0) ||
      !calibration.covariance.isApprox(calibration.covariance.transpose(), 1e-6)) {
    file.fail(file.at("covariance"), "covariance must be a symmetric 6 x 6 matrix");
  }
  calibration.certainty_m = file.number("certainty", 0);
  calibration.frames = file.whole("frames", 0, 1'000'000'000);
  calibration.size_by_markers = file.number("size_by_markers", 0);
  const std::vector<double> sides = file.numbers("side_errors", 4);
  std::copy(sides.begin(), sides.end(), calibration.side_errors.begin());
  for (const Reader& entry : file.sections("references", 200)) {
    ArenaReference reference;
    reference.id = entry.whole("id", -1, 65535);
    const std::vector<double> place = entry.numbers("place", 3);
    const std::vector<double> pixel = entry.numbers("pixel", 2);
    const std::vector<double> residual = entry.numbers("residual", 2);
    reference.place = {place[0], place[1], place[2]};
    reference.pixel = {pixel[0], pixel[1]};
    reference.residual = {residual[0], residual[1]};
    calibration.references.push_back(reference);
  }
}

}  // namespace

std::string origin_name(ArenaOrigin origin) {
  return kOrigins[static_cast<std::size_t>(origin)];
}

std::optional<ArenaOrigin> origin_of(const std::string& name) {
  for (std::size_t i = 0; i < kOrigins.size(); ++i) {
    if (name == kOrigins[i]) return static_cast<ArenaOrigin>(i);
  }
  return std::nullopt;
}

std::string format_arena_file(const ArenaCalibration& calibration) {
  const ArenaCamera& camera = calibration.camera;
  const CameraModel& lens = camera.intrinsics;
  const Distortion& d = lens.distortion;
  std::string text = fmt::format(
      "# Where the arena is in the camera's view. Written by Roundel (roundel calibrate arena);\n"
      "# roundel calibrate restore brings the calibration before it back. Metres, pixels.\n"
      "format: {}\nversion: {}\ndate: {}\n",
      kFormat, quoted(calibration.version), quoted(calibration.date));
  text += fmt::format(
      "camera:\n  identity: {}\n  crop: {}\n  width: {}\n  height: {}\n  fx: {}\n  fy: {}\n"
      "  cx: {}\n  cy: {}\n  distortion: [{}, {}, {}, {}, {}]\n",
      quoted(camera.identity), quoted(camera.crop), lens.width, lens.height, lens.fx, lens.fy,
      lens.cx, lens.cy, d.k1, d.k2, d.p1, d.p2, d.k3);

  const ArenaRequest& request = calibration.request;
  std::vector<std::string> anchors;
  for (const ArenaAnchor& anchor : request.anchors) {
    anchors.push_back(fmt::format("{{id: {}, x: {}, y: {}}}", anchor.id, anchor.x, anchor.y));
  }
  text += fmt::format(
      "arena:\n  width: {}\n  height: {}\n  origin: {}\n  ids: {}\n  anchors: {}\n"
      "  corner_height: {}\n  corner_diameter: {}\n  certainty: {}\n  time_limit: {}\n"
      "  tolerance: {}\n",
      request.width_m, request.height_m, origin_name(request.origin), list(request.ids),
      list(anchors), request.corner_height_m, request.corner_diameter_m, request.certainty_m,
      request.time_limit_s, request.tolerance_m);

  const Eigen::Vector3d& p = calibration.arena_in_camera.position;
  const Eigen::Quaterniond& q = calibration.arena_in_camera.orientation;
  std::vector<double> covariance;
  for (Eigen::Index i = 0; i < 36; ++i) covariance.push_back(calibration.covariance(i / 6, i % 6));
  text += fmt::format(
      "result:\n  position: [{}, {}, {}]\n  orientation: [{}, {}, {}, {}]\n  covariance: {}\n"
      "  certainty: {}\n  frames: {}\n  size_by_markers: {}\n  side_errors: {}\n  references:\n",
      p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), list(covariance), calibration.certainty_m,
      calibration.frames, calibration.size_by_markers, list(calibration.side_errors));
  for (const ArenaReference& r : calibration.references) {
    text +=
        fmt::format("    - {{id: {}, place: [{}, {}, {}], pixel: [{}, {}], residual: [{}, {}]}}\n",
                    r.id, r.place.x(), r.place.y(), r.place.z(), r.pixel.x(), r.pixel.y(),
                    r.residual.x(), r.residual.y());
  }
  return text;
}

ArenaCalibration parse_arena_file(const std::string& text, const std::string& file_name) {
  try {
    const Reader file(parse_bounded_yaml(text, file_name), file_name);
    if (file.whole("format", 0, 1'000'000) != kFormat) {
      file.fail(file.at("format"), fmt::format("this version reads format {} only", kFormat));
    }
    ArenaCalibration calibration;
    calibration.version = file.text("version", 100);
    calibration.date = file.text("date", 100);
    calibration.camera = read_camera(file.section("camera"));
    calibration.request = read_request(file.section("arena"));
    read_result(file.section("result"), calibration);
    return calibration;
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", where(file_name, error.mark), error.msg));
  }
}

ArenaCalibration read_arena_file(const std::string& path) {
  return parse_arena_file(read_text_file(path), path);
}

}  // namespace roundel
