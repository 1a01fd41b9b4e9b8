#pragma once

#include <CLI/CLI.hpp>

// What `roundel calibrate` has below it; as in commands.hpp.
namespace roundel {

void add_calibrate_arena(CLI::App& calibrate);
void add_calibrate_restore(CLI::App& calibrate);
void add_calibrate_camera(CLI::App& calibrate);

}  // namespace roundel
