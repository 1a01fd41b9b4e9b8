#include "tools/recording_reader.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "daemon/image_file.hpp"
#include "daemon/json_fields.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxLine = std::size_t{16} << 20;
constexpr auto kLargest = std::numeric_limits<std::int64_t>::max();

}  // namespace

void RecordingReader::take(std::string_view piece) {
  while (!piece.empty()) {
    if (picture_bytes_ == 0) {
      const std::size_t end = piece.find('\n');
      const std::size_t size = end == std::string_view::npos ? piece.size() : end + 1;
      if (line_.size() + size > kMaxLine) throw std::runtime_error("the recording has no lines");
      line_.append(piece.substr(0, size));
      piece.remove_prefix(size);
      if (line_.back() == '\n') read_line();
    } else {
      const std::size_t size = std::min(piece.size(), picture_bytes_ - pixels_.size());
      pixels_.append(piece.substr(0, size));
      piece.remove_prefix(size);
    }
    if (picture_bytes_ == 0 || pixels_.size() < picture_bytes_) continue;
    frame_.line = line_;
    frame_.picture.data = reinterpret_cast<const std::uint8_t*>(pixels_.data());
    take_frame_(frame_);
    line_.clear();
    pixels_.clear();
    picture_bytes_ = 0;
  }
}

void RecordingReader::read_line() {
  const Json json = Json::parse(line_, nullptr, false);
  if (json.is_discarded()) throw std::runtime_error("the recording has a line that is not JSON");
  if (!has_heading_) {
    has_heading_ = true;
    line_.clear();
    take_heading_(json);
    return;
  }
  const auto width = static_cast<int>(integer_field(json, "width", 1, kMaxImageSide));
  const auto height = static_cast<int>(integer_field(json, "height", 1, kMaxImageSide));
  frame_.number = integer_field(json, "frame", 0, kLargest);
  frame_.utime = integer_field(json, "utime", 0, kLargest);
  frame_.session = integer_field(json, "session", 0, kLargest);
  frame_.unrecorded = integer_field(json, "unrecorded", 0, kLargest);
  frame_.picture = grey_view(nullptr, width, height, width);
  picture_bytes_ = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace roundel
