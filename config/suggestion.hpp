#pragma once

#include <string>
#include <string_view>

namespace roundel {

// The key of the table that an unknown key was most likely meant to be; empty if none is near.
std::string_view nearest_key(std::string_view unknown);

// The keys that a section accepts ("" for the top), separated by commas.
std::string keys_of_section(std::string_view section);

}  // namespace roundel
