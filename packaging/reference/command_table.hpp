#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace roundel {

// What a program's options are, as its parser knows them: the source of its manual page and of its
// completion.
struct OptionEntry {
  std::vector<std::string> names;  // with their dashes; none for a positional argument
  std::string value;               // FILE, METRES; empty: a flag
  std::vector<std::string> choices;
  std::string range;          // "0.001 to 5", or empty
  std::string default_value;  // empty: none
  std::string description;
  std::string group;  // "which markers (one of)", or empty
  std::string needs;  // another option, or empty
  std::string environment;
  bool required = false, repeated = false, value_is_optional = false;

  bool takes_file() const;
};

struct CommandEntry {
  std::string path;  // "calibrate camera"; empty for the program itself
  std::string description;
  std::vector<std::string> subcommands;
  std::vector<OptionEntry> options;
  std::vector<OptionEntry> arguments;  // positional
};

// The program, then every subcommand, those below it after it.
std::vector<CommandEntry> command_table(const CLI::App& program);

}  // namespace roundel
