#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/common/experiment.hpp"
#include "core/luma_view.hpp"

namespace roundel::bench {

// What a system says about one marker in one picture.
struct Sighting {
  int number = -1;            // of the id it read, from 0; -1: no id
  double id_probability = 0;  // of systems that tell
  double u = 0, v = 0;        // of the marker's centre, pixels
  Pose pose;                  // in DESIGN.md's frames, whatever the system's own are
  bool has_sigma = false;
  Eigen::Vector3d sigma_position = Eigen::Vector3d::Zero();  // metres, camera axes
  Eigen::Vector3d sigma_rotation = Eigen::Vector3d::Zero();  // radians, about the camera axes
  double ambiguity = 0;
};

// A marker tracker with its settings, made for one experiment.
class System {
 public:
  virtual ~System() = default;
  virtual const std::string& name() const = 0;
  virtual bool has_yaw() const { return true; }   // false: markers without an x axis and an id
  virtual bool follows() const { return false; }  // wants every view of a continuous experiment

  // How many ids the system has. With fewer than markers, ids are worn twice: marker i wears
  // number i % id_count().
  virtual int id_count() const = 0;

  // The span holds until the next call.
  virtual std::span<const Sighting> look(const LumaView& picture) = 0;
};

using Systems = std::vector<std::unique_ptr<System>>;

}  // namespace roundel::bench
