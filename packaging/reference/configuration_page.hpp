#pragma once

#include <string>
#include <string_view>

namespace roundel {

// Every key of the configuration with its comment in `yaml` (the commented default file), its
// default and what the table of fields says that it accepts: the main part of roundel.yaml(5).
// Throws std::runtime_error for a key of the file that the table does not have.
std::string keys_part(std::string_view yaml);

}  // namespace roundel
