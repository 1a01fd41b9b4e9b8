#pragma once

#include <string_view>

namespace roundel {

// The commented default configuration, config/roundel.yaml, as it was at build time.
std::string_view default_yaml();

}  // namespace roundel
