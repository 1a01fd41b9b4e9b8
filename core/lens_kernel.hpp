#pragma once

#include <array>

#include "core/vector_unit.hpp"

namespace roundel {

// Polynomial of the third order without a constant; terms u, v, uu, uv, vv, uuu, uuv, uvv, vvv.
using Cubic = std::array<float, 9>;

// Replaces offsets in pixels by offsets in normalised coordinates; `count` is a multiple of
// sixteen.
void remove_lens(const std::array<Cubic, 2>& lens, float* x, float* y, int count,
                 VectorUnit unit = VectorUnit::kBest);

}  // namespace roundel
