#pragma once

#include <Eigen/Core>

namespace roundel {

// Where a marker, or the robot that wears it, is in the arena (DESIGN.md section 3): origin at the
// first corner marker, x along the side to the second, y to the fourth, z up from the floor.
struct ArenaPose {
  bool valid = false;                                  // nothing below holds otherwise
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // metres
  double heading = 0;  // of the x axis about z, radians in (-pi, pi]; 0 without a readable code
  Eigen::Vector3d sigma_position = Eigen::Vector3d::Zero();  // one standard deviation, arena axes
  double sigma_heading = 0;  // one standard deviation, radians; pi where the heading is not known
};

}  // namespace roundel
