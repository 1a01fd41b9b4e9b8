#include "packaging/reference/lcm_page.hpp"

#include <algorithm>
#include <vector>

#include "packaging/reference/commented_lines.hpp"
#include "packaging/reference/manual_text.hpp"

namespace roundel {
namespace {

void paragraphs(const std::string& text, ManualText& part) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    part.paragraph(std::string_view(text).substr(at, end - at));
    at = end + 1;
  }
}

// A field or constant as the reader of messages sees it: "float position[3]", "STAMP_UNKNOWN = 0".
std::string tag_of(std::string code) {
  if (const std::size_t semicolon = code.rfind(';'); semicolon != std::string::npos) {
    code.erase(semicolon);
  }
  if (code.starts_with("const ")) code.erase(0, code.find(' ', sizeof "const") + 1);
  return bold(code);
}

// Fields of one type that one comment is about.
struct SharedComment {
  std::vector<std::string> tags;
  std::string type, comment;

  void end(ManualText& part) {
    const bool ends = comment.empty() || comment.back() == '.';
    if (!tags.empty()) part.item(tags, comment + (ends ? "" : "."));
    tags.clear();
    comment.clear();
  }
};

}  // namespace

std::string types_part(std::string_view definitions) {
  ManualText part;
  SharedComment item;
  for (const CommentedLine& line : commented_lines(definitions, "//")) {
    if (line.code.empty() || line.code == "{" || line.code.starts_with("package ")) {
      paragraphs(line.comment, part);
      continue;
    }
    if (line.code == "}") {
      item.end(part);
      continue;
    }
    const bool is_struct = line.code.starts_with("struct ");
    // A comment above describes the field right below, or else everything up to the next one.
    const bool is_constant = line.code.starts_with("const ");
    const bool describes = !is_constant && line.comment.empty();
    const std::string type = line.code.substr(0, line.code.find(' '));
    if (is_struct || is_constant || type != item.type || !line.before.empty() ||
        !line.comment.empty()) {
      item.end(part);
    }
    if (is_struct) part.section(line.code.substr(sizeof "struct"));
    if (is_struct || !describes) paragraphs(line.before, part);
    if (is_struct) continue;
    if (!line.comment.empty() || !line.before.empty()) {
      item.comment = describes ? line.before : line.comment;
    }
    item.type = type;
    item.tags.push_back(tag_of(line.code));
  }
  return part.text();
}

}  // namespace roundel
