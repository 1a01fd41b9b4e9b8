#pragma once

#include <string>
#include <string_view>

namespace roundel {

// Struct by struct and field by field what the .lcm files say: the main part of roundel-lcm(5).
std::string types_part(std::string_view definitions);

}  // namespace roundel
