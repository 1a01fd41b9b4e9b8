#pragma once

#include <string>
#include <vector>

#include "packaging/reference/command_table.hpp"

namespace roundel {

// A completion for bash, without need of the package bash-completion once it is loaded. A value
// KEY=VALUE is completed from the table of configuration keys.
std::string bash_completion(const std::string& program, const std::vector<CommandEntry>& table);

}  // namespace roundel
