#include "tools/calibrate.hpp"

#include "tools/commands.hpp"

namespace roundel {

void add_calibrate(CLI::App& app) {
  auto* command = app.add_subcommand("calibrate", "Calibrate what measuring needs");
  command->require_subcommand(1);
  add_calibrate_arena(*command);
  add_calibrate_restore(*command);
  add_calibrate_camera(*command);
}

}  // namespace roundel
