#pragma once

namespace roundel {

// A pixel rectangle, all four sides included.
struct Box {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  int width() const { return u1 - u0 + 1; }
  int height() const { return v1 - v0 + 1; }
};

}  // namespace roundel
