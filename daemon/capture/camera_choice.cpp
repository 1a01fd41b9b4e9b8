#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "daemon/capture/camera_information.hpp"
#include "daemon/capture/video_device.hpp"

namespace roundel {
namespace {

bool is_at(const CameraInformation& camera, const std::string& path) {
  if (camera.node == path) return true;
  if (std::find(camera.links.begin(), camera.links.end(), path) != camera.links.end()) return true;
  // Any other link, such as one that an udev rule made.
  std::error_code error;
  const std::filesystem::path target = std::filesystem::canonical(path, error);
  return !error && target == camera.node;
}

bool matches(const CameraInformation& camera, const CameraChoice& choice) {
  return camera.problem.empty() && camera.card.find(choice.card) != std::string::npos &&
         (choice.bus.empty() || camera.bus == choice.bus) &&
         (choice.serial.empty() || camera.serial == choice.serial);
}

std::string list(const std::vector<CameraInformation>& cameras) {
  std::vector<std::string> texts;
  texts.reserve(cameras.size());
  for (const CameraInformation& camera : cameras) texts.push_back(describe(camera));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string rules(const CameraChoice& choice) {
  std::vector<std::string> texts;
  if (!choice.card.empty()) texts.push_back(fmt::format("match_card \"{}\"", choice.card));
  if (!choice.bus.empty()) texts.push_back(fmt::format("match_bus \"{}\"", choice.bus));
  if (!choice.serial.empty()) texts.push_back(fmt::format("match_serial \"{}\"", choice.serial));
  return fmt::format("{}", fmt::join(texts, " and "));
}

}  // namespace

std::string describe(const CameraInformation& camera) {
  if (!camera.problem.empty()) return fmt::format("{} ({})", camera.card, camera.problem);
  const std::string serial =
      camera.serial.empty() ? std::string() : fmt::format(", serial {}", camera.serial);
  return fmt::format("{} ({}, {}{})", camera.card, camera.node, camera.bus, serial);
}

CameraInformation choose_camera(const std::vector<CameraInformation>& cameras,
                                const CameraChoice& choice) {
  const std::string others =
      cameras.empty()
          ? "there is no camera that can capture"
          : fmt::format("there {} {}", cameras.size() == 1 ? "is" : "are", list(cameras));
  if (!choice.device.empty()) {
    for (const CameraInformation& camera : cameras) {
      if (!is_at(camera, choice.device)) continue;
      if (!camera.problem.empty()) throw CameraError(camera.problem);
      return camera;
    }
    throw CameraAbsent(fmt::format("no camera is at {}; {}", choice.device, others));
  }
  std::vector<CameraInformation> found;
  std::copy_if(cameras.begin(), cameras.end(), std::back_inserter(found),
               [&](const CameraInformation& camera) { return matches(camera, choice); });
  const std::string rule = rules(choice);
  if (found.empty()) {
    // One that can't be opened may be the one.
    if (!cameras.empty() && rule.empty())
      throw CameraError("no camera can be used: " + list(cameras));
    const bool maybe =
        std::any_of(cameras.begin(), cameras.end(),
                    [](const CameraInformation& camera) { return !camera.problem.empty(); });
    const std::string text =
        rule.empty() ? others : fmt::format("no camera has {}; {}", rule, others);
    if (maybe) throw CameraError(text);
    throw CameraAbsent(text);
  }
  if (found.size() > 1 && !rule.empty()) {
    throw CameraError(fmt::format(
        "{} fits {} cameras: {}; name one by camera.device (a link in /dev/v4l/by-path tells twins "
        "apart), camera.match_serial or camera.match_bus",
        rule, found.size(), list(found)));
  }
  return found.front();
}

CameraInformation find_again(const std::vector<CameraInformation>& cameras,
                             const CameraInformation& before) {
  std::vector<CameraInformation> found;
  std::string problem;
  for (const CameraInformation& camera : cameras) {
    const bool same_place = camera.bus == before.bus;
    if (camera.card != before.card || camera.serial != before.serial) continue;
    if (!camera.problem.empty()) {
      problem = camera.problem;
      continue;
    }
    if (same_place) return camera;
    if (!before.serial.empty()) found.push_back(camera);
  }
  // Twins may share a serial number, too.
  if (found.size() == 1) return found.front();
  if (!problem.empty()) throw CameraError(problem);
  if (cameras.empty()) throw CameraAbsent(fmt::format("{} is not there", describe(before)));
  throw CameraError(fmt::format(
      "{} is not there; there is {}, which is not taken instead (restart roundeld to choose anew)",
      describe(before), list(cameras)));
}

}  // namespace roundel
