#pragma once

#include <string>
#include <vector>

#include "packaging/reference/command_table.hpp"

namespace roundel {

// Options of one command, as a part of a manual page.
std::string options_part(const CommandEntry& command);

// Every subcommand with its options.
std::string subcommands_part(const std::string& program, const std::vector<CommandEntry>& table);

}  // namespace roundel
