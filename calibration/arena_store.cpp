#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "calibration/arena_file.hpp"
#include "calibration/atomic_file.hpp"
#include "calibration/bounded_yaml.hpp"

namespace roundel {
namespace {

std::optional<std::string> contents_of(const std::string& path) {
  std::error_code error;
  if (std::filesystem::status(path, error).type() == std::filesystem::file_type::not_found) {
    return std::nullopt;
  }
  return read_text_file(path);
}

// A damaged file must not push a whole one out of its place.
std::optional<std::string> worth_keeping(const std::string& path) {
  try {
    std::optional<std::string> text = contents_of(path);
    if (text) parse_arena_file(*text, path);
    return text;
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<ArenaCalibration> ArenaStore::load() const {
  const std::optional<std::string> text = contents_of(path_);
  if (!text) return std::nullopt;
  return parse_arena_file(*text, path_);
}

// First the old one is copied away, then replaced: at every instant the file in use is whole.
void ArenaStore::save(const ArenaCalibration& calibration) {
  const std::string text = format_arena_file(calibration);
  const std::optional<std::string> old = worth_keeping(path_);
  if (old) write_file_atomically(previous_path(), *old);
  write_file_atomically(path_, text);
}

ArenaCalibration ArenaStore::restore() {
  const std::optional<std::string> previous = contents_of(previous_path());
  if (!previous) {
    throw std::runtime_error(
        fmt::format("{}: there is no calibration before the one in use", previous_path()));
  }
  const ArenaCalibration calibration = parse_arena_file(*previous, previous_path());
  const std::optional<std::string> current = worth_keeping(path_);
  write_file_atomically(path_, *previous);
  if (current) write_file_atomically(previous_path(), *current);
  return calibration;
}

void ArenaStore::forget() {
  if (::rename(path_.c_str(), previous_path().c_str()) != 0 && errno != ENOENT) {
    throw std::runtime_error(
        fmt::format("{}: can't be put aside: {}", path_, std::strerror(errno)));
  }
}

}  // namespace roundel
