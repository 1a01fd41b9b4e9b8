#pragma once

#include <optional>
#include <string>

#include "calibration/arena_calibration.hpp"

namespace roundel {

// The names of the corners, as users write them: "bottom-left" and so on.
std::string origin_name(ArenaOrigin origin);
std::optional<ArenaOrigin> origin_of(const std::string& name);

// An arena calibration as text (YAML). Numbers read back exactly.
std::string format_arena_file(const ArenaCalibration& calibration);

// Throws std::runtime_error "file:line:column: key: what is wrong".
ArenaCalibration parse_arena_file(const std::string& text, const std::string& file_name);
ArenaCalibration read_arena_file(const std::string& path);

// The daemon's calibration on disk: the one in use and the one before it (PATH.previous). Every
// change is whole or does not happen, whenever the power fails. All throw std::runtime_error that
// names the file.
class ArenaStore {
 public:
  explicit ArenaStore(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  std::string previous_path() const { return path_ + ".previous"; }

  // Nothing if there is none.
  std::optional<ArenaCalibration> load() const;
  void save(const ArenaCalibration& calibration);
  // Exchanges the one in use and the one before it, and returns what is in use then.
  ArenaCalibration restore();
  // None is in use any more; restore() brings it back. False: none was.
  bool forget();

 private:
  std::string path_;
};

}  // namespace roundel
