#include "config/suggestion.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "config/fields.hpp"

namespace roundel {
namespace {

// Insertions, deletions and replacements that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string_view last_part(std::string_view key) {
  return key.substr(key.rfind('.') + 1);
}

}  // namespace

std::string_view nearest_key(std::string_view unknown) {
  constexpr std::size_t kLongestSensible = 80;
  if (unknown.size() > kLongestSensible) return {};
  const std::string_view last = last_part(unknown);
  std::string_view nearest;
  std::size_t nearest_distance = last.size() / 3 + 2;  // exclusive; more is no likeness
  for (const Field& field : fields()) {
    // A right name in a wrong section is nearer than any misspelling but one letter.
    const std::size_t distance =
        std::min(edit_distance(unknown, field.key), edit_distance(last, last_part(field.key)) + 1);
    if (distance < nearest_distance) {
      nearest_distance = distance;
      nearest = field.key;
    }
  }
  return nearest;
}

std::string keys_of_section(std::string_view section) {
  std::string list;
  std::string_view previous;
  for (const Field& field : fields()) {
    std::string_view name = field.key;
    if (!section.empty()) {
      if (!name.starts_with(section) || name.substr(section.size(), 1) != ".") continue;
      name.remove_prefix(section.size() + 1);
    }
    name = name.substr(0, name.find('.'));
    if (name == previous) continue;
    previous = name;
    if (!list.empty()) list += ", ";
    list += name;
  }
  return list;
}

}  // namespace roundel
