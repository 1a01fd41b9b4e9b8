#pragma once

#include <CLI/CLI.hpp>
#include <stdexcept>

// The subcommands of `roundel`, one file each. Every function adds its subcommand with all options
// and a callback that does the work; the callback throws UsageError where the options make no sense
// (exit status 2) and any other std::exception where the data is at fault (exit status 1).
namespace roundel {

struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void add_detect(CLI::App& app);
void add_track(CLI::App& app);
void add_simulate(CLI::App& app);
void add_compare(CLI::App& app);
void add_markers(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_listen(CLI::App& app);
void add_status(CLI::App& app);
void add_reload(CLI::App& app);
void add_snapshot(CLI::App& app);
void add_controls(CLI::App& app);
void add_cameras(CLI::App& app);
void add_record(CLI::App& app);
void add_export(CLI::App& app);
void add_doctor(CLI::App& app);
void add_report(CLI::App& app);

// All of them, in the order in which they are listed.
void add_commands(CLI::App& app);

}  // namespace roundel
