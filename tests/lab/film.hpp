#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/grey_image.hpp"
#include "simulator/arena.hpp"

namespace roundel {

// A rendered piece of the simulated arena that a pretended camera shows, forward and backward
// without end, and what the tracker makes of it directly, with no device in between.
class Film {
 public:
  // The arena's picture has 640x480 pixels and four robots.
  static Film made(int pictures);
  // Making it takes long in the virtual machine: it is made outside, and read there.
  static Film read(const std::string& path);
  void write(const std::string& path) const;
  // The one that all tests share, in the file that ROUNDEL_LAB_FILM names.
  static const Film& shared();

  int pictures() const { return static_cast<int>(pictures_.size()); }
  const GreyImage& picture(int index) const { return pictures_[static_cast<std::size_t>(index)]; }
  // Which picture is shown as the n-th; after period() pictures it begins again.
  int shown(std::int64_t n) const;
  int period() const { return 2 * pictures() - 2; }
  const CameraModel& camera() const { return camera_; }

  // The picture that markers were seen in, and how far they are off there; markers with ids only.
  struct Match {
    int picture = 0;
    double worst_px = 0;  // of a marker's centre
    double mean_px = 0;
    int markers = 0;
  };
  struct Seen {
    int id;
    double u, v;
  };
  std::optional<Match> match(std::span<const Seen> seen) const;

 private:
  Film() = default;

  std::vector<GreyImage> pictures_;
  std::vector<std::vector<Seen>> direct_;  // of the n-th picture shown, forward and backward
  CameraModel camera_;
};

}  // namespace roundel
