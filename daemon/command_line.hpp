#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/reader.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): not ours
class App;
}

namespace roundel {

struct CommandLine {
  enum class Action { kRun, kCheckConfig, kPrintConfig };

  Action action = Action::kRun;
  std::string config;                  // path; empty: the embedded default
  std::vector<std::string> overrides;  // "key.path=value"
  bool lock_memory = false;

  LoadedConfiguration load() const;
};

// The options of roundeld; parsing fills in the command, which must live as long as the app.
void add_options(CLI::App& app, CommandLine& command);

// What is to be done, or the exit status where parsing already did it (--help, --version, usage
// errors, which are told on standard error).
struct ParsedCommandLine {
  std::optional<CommandLine> command;
  int exit_status = 0;
};
ParsedCommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace roundel
