#pragma once

#include <string>
#include <vector>

namespace roundel {

// Ids from text such as "7", "1-12" or "1-4,9,20-22", in the order written. Throws
// std::invalid_argument where the text is no such list, or where an id is not in [1, id_count]; it
// names the range.
std::vector<int> parse_ids(const std::string& text, int id_count);

}  // namespace roundel
