#pragma once

#include <string>

#include "config/configuration.hpp"

namespace roundel {

// The configuration as a file, every key with its value: reading it gives the same configuration,
// but for a token, which is left out. Recordings and bug reports are for others to read.
std::string configuration_yaml(const Configuration& configuration);

}  // namespace roundel
