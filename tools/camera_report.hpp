#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/picture_calibration.hpp"

namespace roundel {

// A picture or frame that was not used, and why.
struct SkippedPicture {
  std::string source, reason;
};

// A camera calibration and what it was made of.
struct CameraReport {
  PictureCalibration calibration;
  Board board;
  std::vector<std::string> sources;  // by ViewResult::picture
  std::vector<SkippedPicture> skipped;
  std::vector<std::string> advice;  // what would make it better
};

// For people: parameters with deviations, errors by view, what was not used, advice.
std::string camera_report_text(const CameraReport& report);

nlohmann::ordered_json camera_report_json(const CameraReport& report);

// What goes into the camera file for whoever opens it later, a line each. `date` as 2026-11-22.
std::vector<std::string> camera_file_comments(const CameraReport& report, const std::string& date);

}  // namespace roundel
