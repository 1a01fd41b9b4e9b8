#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

namespace roundel {

// Whatever could disturb a terminal or a log becomes a space.
inline std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return text;
}

// A text in a field of fixed size, as drivers fill it, terminated or not.
template <typename Character, std::size_t size>
std::string driver_text(const Character (&field)[size]) {
  return printable({field, std::find(field, field + size, Character{0})});
}

}  // namespace roundel
