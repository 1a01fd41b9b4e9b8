#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/control_client.hpp"
#include "tools/doctor/finding.hpp"

namespace roundel {

struct ExaminationOptions {
  std::string socket = kDefaultControlSocket;
  std::string config;  // empty: the running roundeld's, else the installed one
  MachineRoot root;
};

// All checks of this machine, in the order in which one would mend things. Works with and without
// a running roundeld.
std::vector<Finding> examine(const ExaminationOptions& options);

// "problem  route        there is no ...; mend: ...", with its end of line.
std::string finding_text(const Finding& finding);
nlohmann::ordered_json finding_json(const Finding& finding);

}  // namespace roundel
