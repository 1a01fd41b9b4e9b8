#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "core/grey_image.hpp"
#include "core/luma_view.hpp"
#include "daemon/append_file.hpp"
#include "daemon/file_pointer.hpp"

namespace roundel {

// What the header of a YUV4MPEG2 stream tells.
struct Y4mFormat {
  int width = 0, height = 0;              // pixels, within kMaxImageSide
  std::int64_t rate = 30, rate_base = 1;  // frames per second = rate / rate_base
  std::size_t chroma_bytes = 0;           // behind the luma of every frame
  double frames_per_second() const {
    return static_cast<double>(rate) / static_cast<double>(rate_base);
  }
};

// What a recording says about a frame, behind the word FRAME ("XN=12 XT=1700000000000000"); other
// readers pass over it.
struct Y4mStamp {
  std::int64_t number = 0;  // of the frame at its source
  std::int64_t utime = 0;   // of its capture, microseconds since the Unix epoch
};

// Reads raw video (YUV4MPEG2, 8 bits: 4:2:0, 4:1:1, 4:2:2, 4:4:4, mono) as luma, frame by frame.
// All errors are std::runtime_error that names the file, and the frame counted from 0.
class Y4mReader {
 public:
  // Opens the file ("-": standard input) and reads the header.
  explicit Y4mReader(const std::string& path);

  const Y4mFormat& format() const { return format_; }
  std::int64_t frames_read() const { return frames_read_; }
  // Of the frame read last; nothing if the file has none.
  const std::optional<Y4mStamp>& stamp() const { return stamp_; }

  // The next frame; false at the end of the stream. Allocates only to size the image.
  bool next(GreyImage& frame);

 private:
  bool read_line(std::string& line);
  bool at_end();

  std::string name_;
  FilePointer file_;  // owns; empty for standard input
  std::FILE* stream_ = nullptr;
  Y4mFormat format_;
  std::int64_t frames_read_ = 0;
  std::optional<Y4mStamp> stamp_;
  std::string line_;
};

// Writes luma-only raw video (YUV4MPEG2, Cmono). Errors are std::runtime_error that names the file;
// what has been written until then is whole frames.
class Y4mWriter {
 public:
  // Opens the file ("-": standard output) and writes the header.
  Y4mWriter(const std::string& path, int width, int height, double frames_per_second);

  // The frame must have the size given.
  void write(const LumaView& frame, const std::optional<Y4mStamp>& stamp = {});

  // The frame written last was never there.
  void take_back() { file_.take_back(); }

  // Tells of errors that a destructor would have to swallow.
  void close() { file_.close(); }

 private:
  AppendFile file_;
  int width_, height_;
  std::vector<char> pixels_;  // of a frame whose pixels lie apart
};

}  // namespace roundel
