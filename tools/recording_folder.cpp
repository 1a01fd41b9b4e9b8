#include "tools/recording_folder.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "calibration/atomic_file.hpp"
#include "config/reader.hpp"
#include "config/writer.hpp"
#include "daemon/json_fields.hpp"

namespace roundel {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kUsualRate = 30;  // where none has been measured

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw std::runtime_error(fmt::format("{} can't be made: {}", path, error.message()));
  if (!fs::is_empty(path, error)) {
    throw std::runtime_error(
        fmt::format("{} is not empty; a recording needs a folder of its own", path));
  }
}

// The same roundeld, but with the folder's files: to be started in the folder.
std::string replay_yaml(const std::string& configuration, const Json& heading, double frame_rate) {
  Configuration values = parse_configuration(configuration, "the recording's configuration").values;
  values.source = SourceKind::kFiles;
  values.files = {{"frames.y4m"}, frame_rate, false};
  values.camera.calibration = has_field(heading, "camera") ? "camera.yaml" : "";
  values.arena.file = "arena.yaml";
  values.arena.recalibrate = false;
  // Beside a roundeld that runs on.
  values.control.socket = values.control.web = values.control.token = "";
  return "# Plays this recording, in this folder: roundeld --config replay.yaml\n" +
         configuration_yaml(values);
}

}  // namespace

RecordingFolder::RecordingFolder(const std::string& path, const Json& heading)
    : path_(path), frame_rate_(number_field(heading, "frame_rate")) {
  make_folder(path);
  if (frame_rate_ <= 0) frame_rate_ = kUsualRate;
  for (const char* name : {"camera", "arena"}) {
    if (!has_field(heading, name)) continue;
    write_file_atomically(file(name) + ".yaml", string_field(heading, name));
  }
  write_file_atomically(file("replay.yaml"),
                        replay_yaml(string_field(heading, "configuration"), heading, frame_rate_));
  poses_.emplace(file("poses.jsonl"));
}

std::string RecordingFolder::file(const char* name) const {
  return (fs::path(path_) / name).string();
}

void RecordingFolder::add(const RecordingReader::Frame& frame) {
  const LumaView& picture = frame.picture;
  if (!video_) video_.emplace(file("frames.y4m"), picture.width, picture.height, frame_rate_);
  video_->write(picture, Y4mStamp{frame.number, frame.utime});
  try {
    poses_->append(frame.line);
  } catch (...) {
    video_->take_back();
    throw;
  }
  ++frames_;
  bytes_ += static_cast<std::int64_t>(frame.line.size()) +
            std::int64_t{picture.width} * std::int64_t{picture.height};
}

void RecordingFolder::close() {
  poses_->close();
  if (video_) video_->close();
}

}  // namespace roundel
