#include "packaging/reference/commented_lines.hpp"

#include <sstream>

namespace roundel {
namespace {

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

// Where the comment begins, behind a blank or at the start of the line; npos: nowhere.
std::size_t comment_column(const std::string& line, std::string_view mark) {
  std::size_t at = line.find(mark);
  while (at != std::string::npos && at > 0 && line[at - 1] != ' ') at = line.find(mark, at + 1);
  return at;
}

void append(std::string& text, const std::string& more) {
  if (more.empty()) {
    text += '\n';
  } else {
    text += (text.empty() || text.back() == '\n' ? "" : " ") + more;
  }
}

}  // namespace

std::vector<CommentedLine> commented_lines(std::string_view text, std::string_view mark) {
  std::vector<CommentedLine> lines;
  std::istringstream stream{std::string(text)};
  std::string pending;                          // comment lines that wait for their code
  std::size_t open_column = std::string::npos;  // of the comment that may go on below
  for (std::string line; std::getline(stream, line);) {
    const std::size_t column = comment_column(line, mark);
    const std::string code = trimmed(std::string_view(line).substr(0, column));
    const std::string comment = column == std::string::npos
                                    ? ""
                                    : trimmed(std::string_view(line).substr(column + mark.size()));
    if (!code.empty()) {
      lines.push_back({line.find_first_not_of(' '), code, comment, pending});
      pending.clear();
      open_column = column;
    } else if (column == std::string::npos) {  // a blank line ends a comment
      if (!pending.empty()) lines.push_back({0, "", pending, ""});
      pending.clear();
      open_column = std::string::npos;
    } else if (column == open_column) {
      append(lines.back().comment, comment);
    } else {
      append(pending, comment);
    }
  }
  return lines;
}

}  // namespace roundel
