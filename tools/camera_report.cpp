#include "tools/camera_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "calibration/print_quality.hpp"

namespace roundel {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// A value with as many digits as its deviation makes sense of (two of the deviation's), and that.
std::string with_deviation(double value, double sigma) {
  if (!(sigma > 0)) return fmt::format("{:.6g} (not estimated)", value);
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, 9);
  return fmt::format("{:.{}f} ± {:.{}f}", value, digits, sigma, digits);
}

std::string points_text(const CameraReport& report) {
  const IntrinsicCalibration& result = report.calibration.result;
  return fmt::format("{} views of {} x {} markers, {} markers used, {} left out as outliers",
                     result.views.size(), report.board.columns, report.board.rows, result.points,
                     result.outliers);
}

std::vector<std::string> parameter_lines(const IntrinsicCalibration& result) {
  const IntrinsicVector values = to_vector(result.camera);
  const IntrinsicVector sigma = result.sigma();
  std::vector<std::string> lines;
  lines.reserve(kIntrinsicParameters);
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    lines.push_back(fmt::format("{} {}{}", kIntrinsicNames[static_cast<std::size_t>(k)],
                                with_deviation(values[k], sigma[k]), k < kK1 ? " px" : ""));
  }
  return lines;
}

std::string print_line(const CameraReport& report) {
  const PrintQuality print = print_quality(report.board, report.calibration.result.offsets);
  return fmt::format(
      "the print, at {:.4g} mm spacing: markers off by {:.3f} mm, stretched by {:.3f} %, "
      "flat within {:.2f} mm; all taken into account",
      1000 * report.board.spacing_m, 1000 * print.off_m, 100 * print.stretch,
      1000 * print.flatness_m);
}

std::string precision_line(const IntrinsicCalibration& result) {
  return fmt::format("total error {:.4f} px; at the worst place of the picture ± {:.2g} px",
                     result.error_px, result.worst_px);
}

std::string views_text(const CameraReport& report) {
  std::size_t width = 7;
  for (const std::string& source : report.sources) width = std::max(width, source.size());
  std::string text = fmt::format("{:{}}  markers  outliers  error px  tilt\n", "picture", width);
  for (const ViewResult& view : report.calibration.result.views) {
    text += fmt::format("{:{}}  {:7}  {:8}  {:8.4f}  {:3.0f}°\n",
                        report.sources[static_cast<std::size_t>(view.picture)], width, view.points,
                        view.outliers, view.error_px, view.tilt * kDegrees);
  }
  return text;
}

}  // namespace

std::string camera_report_text(const CameraReport& report) {
  const IntrinsicCalibration& result = report.calibration.result;
  std::string text = views_text(report);
  for (const SkippedPicture& skipped : report.skipped)
    text += fmt::format("not used: {}: {}\n", skipped.source, skipped.reason);
  text += fmt::format("\n{} x {} pixels, {}\n{}\n", result.camera.width, result.camera.height,
                      points_text(report), precision_line(result));
  for (const std::string& line : parameter_lines(result)) text += "  " + line + "\n";
  if (!result.offsets.empty()) text += print_line(report) + "\n";
  if (!report.advice.empty()) text += "a better one needs more views of the board:\n";
  for (const std::string& advice : report.advice) text += "  " + advice + "\n";
  return text;
}

nlohmann::ordered_json camera_report_json(const CameraReport& report) {
  using Json = nlohmann::ordered_json;
  const IntrinsicCalibration& result = report.calibration.result;
  const IntrinsicVector values = to_vector(result.camera);
  const IntrinsicVector sigma = result.sigma();
  const PrintQuality print = print_quality(report.board, result.offsets);
  Json parameters = Json::object(), deviations = Json::object();
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    const char* name = kIntrinsicNames[static_cast<std::size_t>(k)];
    parameters[name] = values[k];
    deviations[name] = sigma[k];
  }
  Json views = Json::array(), skipped = Json::array();
  for (const ViewResult& view : result.views) {
    const Eigen::Vector3d& p = view.board_in_camera.position;
    const Eigen::Quaterniond& q = view.board_in_camera.orientation;
    views.push_back({{"source", report.sources[static_cast<std::size_t>(view.picture)]},
                     {"markers", view.points},
                     {"outliers", view.outliers},
                     {"error_px", view.error_px},
                     {"tilt", view.tilt},
                     {"position", {p.x(), p.y(), p.z()}},
                     {"orientation", {q.w(), q.x(), q.y(), q.z()}}});
  }
  for (const SkippedPicture& picture : report.skipped)
    skipped.push_back({{"source", picture.source}, {"reason", picture.reason}});
  return {{"width", result.camera.width},
          {"height", result.camera.height},
          {"parameters", parameters},
          {"sigma", deviations},
          {"error_px", result.error_px},
          {"worst_sigma_px", result.worst_px},
          {"markers", result.points},
          {"outliers", result.outliers},
          {"print",
           {{"off_m", print.off_m}, {"stretch", print.stretch}, {"flatness_m", print.flatness_m}}},
          {"rounds", report.calibration.rounds},
          {"views", views},
          {"skipped", skipped},
          {"advice", report.advice}};
}

std::vector<std::string> camera_file_comments(const CameraReport& report, const std::string& date) {
  std::vector<std::string> lines = {
      fmt::format("Made by roundel calibrate camera on {}: {}.", date, points_text(report)),
      precision_line(report.calibration.result) + ". Values with one standard deviation:"};
  lines[1][0] = 'T';
  for (const std::string& line : parameter_lines(report.calibration.result))
    lines.push_back("  " + line);
  return lines;
}

}  // namespace roundel
