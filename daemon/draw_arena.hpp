#pragma once

#include <cairo.h>

#include "calibration/arena_calibration.hpp"

namespace roundel {

// Draws a calibrated arena over a picture whose pixel (0, 0) has its centre at cairo's (0.5, 0.5):
// a grid on the floor, bent as the lens bends it, the axes from the origin (x red, y green), and a
// ring where every fixed marker should be.
void draw_arena(cairo_t* context, const ArenaCalibration& calibration);

// The distance of the grid's lines: 1, 2 or 5 times a power of ten, for at most 20 lines a side.
double grid_step(double side_m);

}  // namespace roundel
