#pragma once

namespace roundel {

// What std::floor, std::ceil and std::lround would give, for numbers that an int can hold (of two
// equally near integers the upper one), without a call where processors have no instruction for it.
inline int floor_int(double x) {
  const int whole = static_cast<int>(x);
  return whole - (whole > x ? 1 : 0);
}
inline int ceil_int(double x) {
  const int whole = static_cast<int>(x);
  return whole + (whole < x ? 1 : 0);
}
inline int nearest_int(double x) {
  return floor_int(x + 0.5);
}

}  // namespace roundel
