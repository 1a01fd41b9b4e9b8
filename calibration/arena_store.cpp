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

// Both files are on the disk before either takes its place: if it is full, nothing has changed. Of
// the two the copy of the old one comes first, so that the file in use is whole at every instant.
void ArenaStore::save(const ArenaCalibration& calibration) {
  StagedFile fresh(path_, format_arena_file(calibration));
  if (const std::optional<std::string> old = worth_keeping(path_)) {
    write_file_atomically(previous_path(), *old);
  }
  fresh.take_its_place();
}

ArenaCalibration ArenaStore::restore() {
  const std::optional<std::string> previous = contents_of(previous_path());
  if (!previous) {
    throw std::runtime_error(
        fmt::format("{}: there is no calibration before the one in use", previous_path()));
  }
  ArenaCalibration calibration = parse_arena_file(*previous, previous_path());
  StagedFile restored(path_, *previous);
  if (const std::optional<std::string> current = worth_keeping(path_)) {
    write_file_atomically(previous_path(), *current);
  }
  restored.take_its_place();
  return calibration;
}

// A damaged one makes way without taking the place of the one before.
bool ArenaStore::forget() {
  const bool keep = worth_keeping(path_) || !worth_keeping(previous_path());
  const int failed =
      keep ? ::rename(path_.c_str(), previous_path().c_str()) : ::unlink(path_.c_str());
  if (failed != 0) {
    if (errno == ENOENT) return false;
    throw std::runtime_error(
        fmt::format("{}: can't be put aside: {}", path_, std::strerror(errno)));
  }
  sync_folder_of(path_);
  return true;
}

}  // namespace roundel
