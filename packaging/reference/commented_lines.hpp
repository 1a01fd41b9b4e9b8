#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace roundel {

// A line of a commented file (YAML, LCM types) with what its comments say about it.
struct CommentedLine {
  std::size_t indentation = 0;
  std::string code;  // without the comment; empty for a comment that stands by itself
  std::string
      comment;  // behind the code, going on below it in the same column; or the one by itself
  std::string before;  // on the lines right above; an empty comment line makes a paragraph: "\n"
};

// `mark` begins a comment: "#" or "//".
std::vector<CommentedLine> commented_lines(std::string_view text, std::string_view mark);

}  // namespace roundel
