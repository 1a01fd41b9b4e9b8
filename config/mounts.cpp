#include "config/mounts.hpp"

#include <array>
#include <charconv>
#include <sstream>

namespace roundel {
namespace {

constexpr int kHighestId = 65535;

struct MountValue {
  const char* name;
  double MarkerMount::*target;
  double least, most;
};
constexpr std::array kValues = {
    MountValue{"height", &MarkerMount::height_m, 0, 10},
    MountValue{"offset_x", &MarkerMount::offset_x_m, -10, 10},
    MountValue{"offset_y", &MarkerMount::offset_y_m, -10, 10},
    MountValue{"rotation", &MarkerMount::rotation, -6.3, 6.3},
};

template <typename Number>
bool read(const std::string& text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

bool assign(const std::string& word, MarkerMount& mount) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) return false;
  for (const MountValue& value : kValues) {
    if (word.compare(0, equals, value.name) != 0) continue;
    double number = 0;
    if (!read(word.substr(equals + 1), number)) return false;
    mount.*value.target = number;
    return number >= value.least && number <= value.most;  // false for NaN
  }
  return false;
}

}  // namespace

std::optional<IdMount> parse_mount(const std::string& text, const MarkerMount& usual) {
  std::istringstream words(text);
  std::string word;
  IdMount result{0, usual};
  if (!(words >> word) || !read(word, result.id) || result.id < 1 || result.id > kHighestId) {
    return std::nullopt;
  }
  while (words >> word) {
    if (!assign(word, result.mount)) return std::nullopt;
  }
  return result;
}

MarkerMounts marker_mounts(const MountSettings& settings) {
  MarkerMounts mounts;
  mounts.usual = {settings.height, settings.offset_x, settings.offset_y, settings.rotation};
  for (const std::string& text : settings.mounts) {
    if (const auto mount = parse_mount(text, mounts.usual)) mounts.by_id.push_back(*mount);
  }
  return mounts;
}

}  // namespace roundel
