#pragma once

#include <string_view>

namespace roundel {

// page.html, as it is part of the program.
std::string_view page_html();

}  // namespace roundel
