#include "tools/id_list.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>
#include <string_view>

namespace roundel {
namespace {

int parse_id(std::string_view part, std::string_view whole, int id_count) {
  int id = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), id);
  if (error == std::errc::invalid_argument || end != part.data() + part.size()) {
    throw std::invalid_argument(
        fmt::format("\"{}\" is not a list of ids such as 1-4,9,20-22", whole));
  }
  if (error != std::errc() || id < 1 || id > id_count) {
    throw std::invalid_argument(
        fmt::format("there is no id {}; this set has the ids 1 to {}", part, id_count));
  }
  return id;
}

}  // namespace

std::vector<int> parse_ids(const std::string& text, int id_count) {
  std::vector<int> ids;
  std::string_view rest = text;
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    more = comma != std::string_view::npos;
    const std::string_view part = rest.substr(0, comma);
    rest.remove_prefix(more ? comma + 1 : 0);
    const std::size_t dash = part.find('-', 1);
    const int first = parse_id(part.substr(0, dash), text, id_count);
    const int last =
        dash == std::string_view::npos ? first : parse_id(part.substr(dash + 1), text, id_count);
    if (last < first) {
      throw std::invalid_argument(fmt::format("the range {} runs backwards", part));
    }
    for (int id = first; id <= last; ++id) {
      ids.push_back(id);
    }
  }
  return ids;
}

}  // namespace roundel
