#pragma once

#include <exception>
#include <string>

namespace roundel {

// What the std::exception that a call throws says; empty if it throws nothing.
template <typename Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

}  // namespace roundel
