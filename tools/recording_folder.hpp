#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "daemon/y4m.hpp"
#include "tools/recording_reader.hpp"

namespace roundel {

// A recording on disk, a folder:
//   frames.y4m    the pictures, luma, with number and time of every frame
//   poses.jsonl   what roundeld found in them, a JSON object a frame
//   camera.yaml, arena.yaml   the calibrations in use, where there were any
//   replay.yaml   roundeld's configuration, with these files as its source
// Whatever happens, frames.y4m and poses.jsonl hold the same frames, whole.
class RecordingFolder {
 public:
  // Makes the folder; throws std::runtime_error if there is something in it already.
  RecordingFolder(const std::string& path, const nlohmann::ordered_json& heading);

  // Throws std::runtime_error that names the file; the frames before stay.
  void add(const RecordingReader::Frame& frame);
  void close();

  std::int64_t frames() const { return frames_; }
  std::int64_t bytes() const { return bytes_; }

 private:
  std::string file(const char* name) const;

  std::string path_;
  double frame_rate_ = 0;
  std::optional<AppendFile> poses_;
  std::optional<Y4mWriter> video_;  // made with the first frame
  std::int64_t frames_ = 0, bytes_ = 0;
};

}  // namespace roundel
