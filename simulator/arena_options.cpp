#include "simulator/arena_options.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/necklace.hpp"

namespace roundel {

namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument(message);
}

}  // namespace

const ArenaOptions& checked(const ArenaOptions& o) {
  require(o.image_width >= 16 && o.image_height >= 16, "the image must be at least 16 x 16 pixels");
  require(o.frame_rate > 0 && o.frame_rate <= 10000, "frame_rate must lie in (0, 10000]");
  require(o.robots >= 0 && o.robots <= 5000, "robots must lie between 0 and 5000");
  require(o.diameter_m > 0 && o.diameter_m < 10, "diameter_m must lie in (0, 10) m");
  require(o.plate_ratio >= 1 && o.plate_ratio < 10, "plate_ratio must lie in [1, 10)");
  require(o.length_m > 0 && o.width_m > 0 && o.length_m <= 100 && o.width_m <= 100,
          "length_m and width_m must lie in (0, 100] m");
  require(
      o.min_height_m >= 0 && o.max_height_m >= o.min_height_m && o.max_height_m < o.camera_height_m,
      "marker heights must rise from 0 to below the camera: min_height_m <= max_height_m < "
      "camera_height_m");
  require(std::abs(o.camera_tilt) < 1.2, "camera_tilt must lie within 1.2 rad");
  require(std::isfinite(o.camera_turn), "camera_turn must be an angle in radians");
  require(o.max_speed >= 0 && o.max_speed <= 5, "max_speed must lie between 0 and 5 m/s");
  require(o.max_turn_rate >= 0 && o.max_turn_rate <= 10, "max_turn_rate must lie in [0, 10] rad/s");
  return o;
}

std::vector<int> worn_ids(const ArenaOptions& options) {
  const auto robots = static_cast<std::size_t>(options.robots);
  const std::size_t corners = options.corners && options.corner_kind == MarkerKind::WhyCode ? 4 : 0;
  if (options.bits == 0) {
    require(corners == 0, "corner markers with codes need bits between 2 and 16");
    require(options.robot_ids.empty(),
            "robot_ids cannot be worn by markers without a code (bits 0)");
    return {};
  }
  const NecklaceCode code(options.bits, options.hamming);
  const auto name = [&] {
    return std::to_string(options.bits) + "-bit codes with Hamming distance " +
           std::to_string(options.hamming) + " have " + std::to_string(code.id_count());
  };
  std::vector<int> ids = options.robot_ids;
  require(ids.empty() || ids.size() == robots, "robot_ids has " + std::to_string(ids.size()) +
                                                   " ids for " + std::to_string(robots) +
                                                   " robots; give one a robot, or none");
  for (const int id : ids) {
    require(code.word(id).has_value(), "id " + std::to_string(id) + " does not exist: " + name());
  }
  int next = ids.empty() ? 1 : *std::max_element(ids.begin(), ids.end()) + 1;
  while (ids.size() < robots + corners) ids.push_back(next++);
  if (ids.empty() || ids.back() <= code.id_count()) return ids;

  std::string message = "the markers need " + std::to_string(ids.back()) + " ids, but " + name();
  for (int bits = options.bits + 1; bits <= kMaxBits; ++bits) {
    const int count = NecklaceCode(bits, options.hamming).id_count();
    if (count < ids.back()) continue;
    throw std::invalid_argument(message + "; " + std::to_string(bits) + " bits would do (" +
                                std::to_string(count) + " ids)");
  }
  throw std::invalid_argument(message + ", and no code up to 16 bits has so many");
}

}  // namespace roundel
