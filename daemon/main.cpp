#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "config/default_yaml.hpp"
#include "daemon/command_line.hpp"
#include "daemon/daemon.hpp"
#include "daemon/lock_memory.hpp"
#include "daemon/log.hpp"
#include "daemon/service/service_link.hpp"
#include "daemon/setup.hpp"

namespace {

enum ExitStatus { kSuccess = 0, kDataError = 1, kUsageError = 2 };

// Everything that can be checked without starting; whether a camera is there is not.
void check(const roundel::LoadedConfiguration& configuration) {
  const auto source = roundel::make_source(configuration);
  const auto camera = roundel::make_camera(configuration, *source);
  roundel::make_tracker(configuration, camera);
  roundel::check_broadcast(configuration);
  fmt::print("{}: the configuration is right\n", configuration.name);
}

int run(const roundel::CommandLine& command) {
  using Action = roundel::CommandLine::Action;
  if (command.action == Action::kPrintConfig) {
    fmt::print("{}", roundel::default_yaml());
    return kSuccess;
  }
  if (command.action == Action::kCheckConfig) {
    check(command.load());
    return kSuccess;
  }
  ::signal(SIGPIPE, SIG_IGN);  // a closed log must not end it
  roundel::SignalDescriptor signals;
  if (command.lock_memory) roundel::lock_memory();
  return roundel::Daemon([&] { return command.load(); }, signals, roundel::service_manager()).run();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const roundel::ParsedCommandLine parsed = roundel::parse_command_line(argc, argv);
    return parsed.command ? run(*parsed.command) : parsed.exit_status;
  } catch (const roundel::ConfigError& error) {
    roundel::log_error("{}", error.what());
    return kUsageError;
  } catch (const std::exception& error) {
    roundel::log_error("{}", error.what());
    return kDataError;
  }
}
