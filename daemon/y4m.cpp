#include "daemon/y4m.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "daemon/image_codecs.hpp"

namespace roundel {
namespace {

constexpr std::string_view kMagic = "YUV4MPEG2";
constexpr std::string_view kFrame = "FRAME";
constexpr std::size_t kMaxLine = 4096;

template <typename Number>
std::optional<Number> parse(std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

// Bytes of chroma behind w x h luma samples; nothing for colour spaces that are not read.
std::optional<std::size_t> chroma_bytes(std::string_view space, std::size_t w, std::size_t h) {
  if (space == "mono") {
    return 0;
  }
  if (space == "420" || space == "420jpeg" || space == "420mpeg2" || space == "420paldv") {
    return 2 * ((w + 1) / 2) * ((h + 1) / 2);
  }
  if (space == "411") {
    return 2 * ((w + 3) / 4) * h;
  }
  if (space == "422") {
    return 2 * ((w + 1) / 2) * h;
  }
  if (space == "444") {
    return 2 * w * h;
  }
  if (space == "444alpha") {
    return 3 * w * h;
  }
  return std::nullopt;
}

void parse_rate(std::string_view text, Y4mFormat& format) {
  const auto colon = text.find(':');
  const auto rate = parse<std::int64_t>(text.substr(0, colon));
  // Without a colon there is nothing behind it, which is no number.
  const std::string_view behind =
      colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
  const auto base = parse<std::int64_t>(behind);
  if (!rate || !base || *rate < 0 || *base < 0) {
    throw std::runtime_error(fmt::format("has the frame rate \"{}\", not as in F30:1", text));
  }
  if (*rate > 0 && *base > 0) {  // 0:0 is "unknown"
    format.rate = *rate;
    format.rate_base = *base;
  }
}

Y4mFormat parse_header(std::string_view header) {
  if (header.substr(0, kMagic.size()) != kMagic ||
      (header.size() > kMagic.size() && header[kMagic.size()] != ' ')) {
    throw std::runtime_error("is not y4m video: it does not start with YUV4MPEG2");
  }
  Y4mFormat format;
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::string_view space = "420";
  std::string_view rest = header.substr(kMagic.size());
  while (!rest.empty()) {
    rest.remove_prefix(1);
    const std::string_view tag = rest.substr(0, rest.find(' '));
    rest.remove_prefix(tag.size());
    if (tag.empty()) {
      continue;
    }
    const std::string_view value = tag.substr(1);
    switch (tag[0]) {
      case 'W':
      case 'H': {
        const auto side = parse<std::uint64_t>(value);
        if (!side) {
          throw std::runtime_error(fmt::format("has \"{}\" in its header, not a size", tag));
        }
        (tag[0] == 'W' ? width : height) = *side;
        break;
      }
      case 'F':
        parse_rate(value, format);
        break;
      case 'C':
        space = value;
        break;
      default:  // interlacing, pixel aspect, comments: no matter
        break;
    }
  }
  if (width == 0 || height == 0) {
    throw std::runtime_error("has no width (W) or no height (H) in its y4m header");
  }
  check_image_size(width, height);
  const auto chroma = chroma_bytes(space, width, height);
  if (!chroma) {
    throw std::runtime_error(
        fmt::format("has the colour space C{}; 8-bit C420, C411, C422, C444 and Cmono can be read "
                    "(with ffmpeg: -pix_fmt gray)",
                    space));
  }
  format.width = static_cast<int>(width);
  format.height = static_cast<int>(height);
  format.chroma_bytes = *chroma;
  return format;
}

// Of "FRAME XN=12 XT=1700000000000000"; damaged stamps are none.
std::optional<Y4mStamp> parse_stamp(std::string_view line) {
  const auto number_behind = [&](std::string_view tag) -> std::optional<std::int64_t> {
    const std::size_t at = line.find(tag);
    if (at == std::string_view::npos) return std::nullopt;
    const std::string_view text = line.substr(at + tag.size());
    return parse<std::int64_t>(text.substr(0, text.find(' ')));
  };
  const auto number = number_behind(" XN=");
  const auto utime = number_behind(" XT=");
  if (!number || !utime || *number < 0 || *utime < 0) return std::nullopt;
  return Y4mStamp{*number, *utime};
}

FilePointer open_file(const std::string& path) {
  FilePointer file(std::fopen(path.c_str(), "rbe"));
  if (!file) {
    throw std::runtime_error(fmt::format("{} can't be opened: {}", path, std::strerror(errno)));
  }
  return file;
}

}  // namespace

Y4mReader::Y4mReader(const std::string& path)
    : name_(path == "-" ? "standard input" : path),
      file_(path == "-" ? nullptr : open_file(path)),
      stream_(file_ ? file_.get() : stdin) {
  line_.reserve(kMaxLine);
  try {
    if (!read_line(line_)) {
      throw std::runtime_error(line_.empty() ? "is empty"
                                             : "is not y4m video: its first line has no end");
    }
    format_ = parse_header(line_);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{} {}", name_, error.what()));
  }
}

// A line without its end; false where the stream or the patience ends first.
bool Y4mReader::read_line(std::string& line) {
  line.clear();
  while (line.size() < kMaxLine) {
    const int c = std::getc(stream_);
    if (c == EOF) {
      return false;
    }
    if (c == '\n') {
      return true;
    }
    line.push_back(static_cast<char>(c));
  }
  return false;
}

bool Y4mReader::at_end() {
  const int c = std::getc(stream_);
  if (c == EOF) {
    if (std::ferror(stream_) != 0) {
      throw std::runtime_error(fmt::format("{}, frame {}, can't be read: {}", name_, frames_read_,
                                           std::strerror(errno)));
    }
    return true;
  }
  std::ungetc(c, stream_);
  return false;
}

bool Y4mReader::next(GreyImage& frame) {
  if (at_end()) {
    return false;
  }
  const auto fail = [&](std::string_view what) {
    throw std::runtime_error(fmt::format("{}, frame {}, {}", name_, frames_read_, what));
  };
  if (!read_line(line_) || std::string_view(line_).substr(0, kFrame.size()) != kFrame ||
      (line_.size() > kFrame.size() && line_[kFrame.size()] != ' ')) {
    fail(std::feof(stream_) != 0 ? "is truncated" : "does not start with FRAME");
  }
  stamp_ = parse_stamp(line_);
  frame.resize(format_.width, format_.height);
  if (std::fread(frame.pixels.data(), 1, frame.pixels.size(), stream_) != frame.pixels.size()) {
    fail("is truncated");
  }
  std::array<std::uint8_t, 16384> skipped = {};
  for (std::size_t left = format_.chroma_bytes; left > 0;) {
    const std::size_t part = std::min(left, skipped.size());
    if (std::fread(skipped.data(), 1, part, stream_) != part) {
      fail("is truncated");
    }
    left -= part;
  }
  ++frames_read_;
  return true;
}

Y4mWriter::Y4mWriter(const std::string& path, int width, int height, double frames_per_second)
    : file_(path), width_(width), height_(height) {
  // Whole rates as they are, others to a thousandth.
  const bool whole = frames_per_second == std::floor(frames_per_second);
  const std::int64_t base = whole ? 1 : 1000;
  file_.append(fmt::format("{} W{} H{} F{}:{} Ip A1:1 Cmono\n", kMagic, width, height,
                           std::llround(frames_per_second * static_cast<double>(base)), base));
}

void Y4mWriter::write(const LumaView& frame, const std::optional<Y4mStamp>& stamp) {
  if (frame.width != width_ || frame.height != height_) {
    throw std::runtime_error(fmt::format("{}: a frame of {}x{} does not fit into video of {}x{}",
                                         file_.name(), frame.width, frame.height, width_, height_));
  }
  const std::string head =
      stamp ? fmt::format("{} XN={} XT={}\n", kFrame, stamp->number, stamp->utime)
            : fmt::format("{}\n", kFrame);
  const auto row_bytes = static_cast<std::size_t>(width_);
  const std::size_t bytes = row_bytes * static_cast<std::size_t>(height_);
  if (frame.pixel_stride == 1 && frame.row_stride == width_) {
    file_.append(head, {reinterpret_cast<const char*>(frame.data), bytes});
    return;
  }
  pixels_.resize(bytes);
  char* out = pixels_.data();
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u) *out++ = static_cast<char>(frame.at(u, v));
  }
  file_.append(head, {pixels_.data(), bytes});
}

}  // namespace roundel
