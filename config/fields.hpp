#pragma once

#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/configuration.hpp"

namespace roundel {

// Where the value of a key lives in a Configuration, and so its type.
using FieldTarget = std::variant<bool*, int*, double*, std::string*, std::vector<std::string>*,
                                 std::map<std::string, std::string>*, SourceKind*>;

// One key of roundel.yaml. Everything that knows about keys (reader, overrides, error messages,
// differences, tests of the sample file) is driven by this table.
struct Field {
  std::string_view key;  // "section.name", or "name" at the top
  FieldTarget (*target)(Configuration&);
  double min = 0, max = 0;         // numbers: the range, inclusive; text: of its length
  bool (*rule)(FieldTarget) = {};  // what a range can't say; the value is in range when it is asked
  std::string_view accepted = {};  // for error messages; empty: made from type and range
};

std::span<const Field> fields();

// The field of a key, or nullptr.
const Field* find_field(std::string_view key);

// Whether the table has keys "name.something".
bool is_section(std::string_view name);

// What a key accepts, in words.
std::string accepted_values(const Field& field);

// The keys whose values differ.
std::vector<std::string_view> changed_keys(const Configuration& a, const Configuration& b);

}  // namespace roundel
