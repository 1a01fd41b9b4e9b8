#include "tools/commands.hpp"

namespace roundel {

void add_commands(CLI::App& app) {
  app.require_subcommand(1);
  add_detect(app);
  add_track(app);
  add_simulate(app);
  add_compare(app);
  add_markers(app);
  add_calibrate(app);
  add_listen(app);
  add_status(app);
  add_reload(app);
  add_snapshot(app);
  add_controls(app);
  add_record(app);
  add_export(app);
  add_doctor(app);
  add_report(app);
  add_cameras(app);
}

}  // namespace roundel
