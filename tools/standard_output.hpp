#pragma once

#include <string>

namespace roundel {

// Writes to standard output at once. Throws std::runtime_error if that fails.
void print(const std::string& text);

}  // namespace roundel
