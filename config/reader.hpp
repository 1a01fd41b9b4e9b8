#pragma once

#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "config/configuration.hpp"

namespace roundel {

// "file:line:column: key: what is wrong; accepted: what would be right"
struct ConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct LoadedConfiguration {
  Configuration values;
  std::string name;                            // of the file, for messages
  std::map<std::string, std::string> origins;  // where each key was set: "file:line:column"

  // A ConfigError about a key's value, for checks that only the user of the value can make.
  ConfigError error(const std::string& key, std::string_view what) const;
};

// Reads a configuration: defaults, then the YAML text, then overrides "key.path=value", all
// validated against the table in fields.cpp and against each other. Throws ConfigError.
LoadedConfiguration parse_configuration(std::string_view yaml, const std::string& name,
                                        std::span<const std::string> overrides = {});

// The same for a file.
LoadedConfiguration read_configuration(const std::string& path,
                                       std::span<const std::string> overrides = {});

// The same for the embedded default.
LoadedConfiguration default_configuration(std::span<const std::string> overrides = {});

}  // namespace roundel
