#include "daemon/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "daemon/log.hpp"

namespace roundel {

LoadedConfiguration CommandLine::load() const {
  return config.empty() ? default_configuration(overrides) : read_configuration(config, overrides);
}

void add_options(CLI::App& app, CommandLine& command) {
  app.set_version_flag("--version", "roundeld " ROUNDEL_VERSION);
  app.add_option("--config", command.config,
                 "configuration (YAML); without it the built-in default runs: a simulated arena")
      ->type_name("FILE");
  app.add_option("--set", command.overrides,
                 "sets one key of the configuration, as in --set simulator.robots=30; may be "
                 "repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_flag("--lock-memory", command.lock_memory,
               "keeps all of its memory from being swapped out")
      ->envname("ROUNDEL_LOCK_MEMORY");
  const auto act = [&command](CommandLine::Action action) {
    return [&command, action] { command.action = action; };
  };
  auto* const check_flag =
      app.add_flag_callback("--check-config", act(CommandLine::Action::kCheckConfig),
                            "says whether the configuration is right, and ends");
  app.add_flag_callback("--print-config", act(CommandLine::Action::kPrintConfig),
                        "prints the built-in default, with comments, and ends")
      ->excludes(check_flag);
}

ParsedCommandLine parse_command_line(int argc, const char* const* argv) {
  constexpr int kUsageError = 2;
  CommandLine command;
  CLI::App app(
      "Watches an arena through a camera, finds circular markers and broadcasts their poses over "
      "LCM. SIGHUP reads the configuration again, SIGTERM and SIGINT end it.",
      "roundeld");
  add_options(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return {std::nullopt, app.exit(error)};
    std::string message = error.what();
    std::replace(message.begin(), message.end(), '\n', ' ');
    log_error("{} (roundeld --help lists the options)", message);
    return {std::nullopt, kUsageError};
  }
  return {command, 0};
}

}  // namespace roundel
