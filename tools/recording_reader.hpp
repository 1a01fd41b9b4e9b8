#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/luma_view.hpp"

namespace roundel {

// Takes the stream of POST /v1/recording apart: a line of JSON about the recording, then for every
// frame a line of JSON and the bytes of its picture. Pieces may end anywhere.
class RecordingReader {
 public:
  struct Frame {
    std::string_view line;  // JSON with its end of line
    std::int64_t number = 0, utime = 0, session = 0, unrecorded = 0;
    LumaView picture;
  };
  using TakeHeading = std::function<void(const nlohmann::ordered_json&)>;
  using TakeFrame = std::function<void(const Frame&)>;  // holds for the call

  RecordingReader(TakeHeading take_heading, TakeFrame take_frame)
      : take_heading_(std::move(take_heading)), take_frame_(std::move(take_frame)) {}

  // Throws std::runtime_error for what is no such stream.
  void take(std::string_view piece);

 private:
  void read_line();

  TakeHeading take_heading_;
  TakeFrame take_frame_;
  bool has_heading_ = false;
  std::string line_;               // grows up to its end
  std::size_t picture_bytes_ = 0;  // of the frame whose line has come; 0: a line comes next
  Frame frame_;
  std::string pixels_;
};

}  // namespace roundel
