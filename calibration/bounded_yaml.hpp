#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <string>

namespace roundel {

// What a YAML file of ours may be at most; far above what any real one needs. The depth is checked
// while parsing, before recursion gets anywhere near the end of the stack.
struct YamlLimits {
  std::size_t bytes = std::size_t{1} << 18;
  int depth = 16;
  int nodes = 20000;
};

// A file's contents. Throws std::runtime_error that names the file if it can't be read or is larger
// than `max_bytes`.
std::string read_text_file(const std::string& path, std::size_t max_bytes = YamlLimits{}.bytes);

// One YAML document without anchors and aliases (so it is a tree). Throws std::runtime_error
// "name:line:column: what" if it is broken or exceeds the limits. Empty text gives a null node.
YAML::Node parse_bounded_yaml(const std::string& text, const std::string& name,
                              const YamlLimits& limits = {});

// "name:line:column" of a node, counted from 1.
std::string where(const std::string& name, const YAML::Mark& mark);

}  // namespace roundel
