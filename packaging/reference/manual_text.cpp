#include "packaging/reference/manual_text.hpp"

#include <fmt/format.h>

#include <sstream>
#include <stdexcept>

namespace roundel {
namespace {

constexpr std::size_t kWidth = 78;

// One word of prose. Hyphens at its start, as in --json and -1, are not typographic ones.
std::string word_of_prose(std::string_view word, bool& is_literal) {
  std::string text;
  bool at_start = true;
  for (const char c : word) {
    if (c == '`') {
      is_literal = !is_literal;
      text += is_literal ? "\\fB" : "\\fR";
      continue;
    }
    if (c == '-' && !at_start && !is_literal) {
      text += '-';
    } else {
      text += literal(std::string_view(&c, 1));
    }
    at_start = at_start && (c == '-' || c == '(' || c == '"' || c == '[');
  }
  return text;
}

}  // namespace

std::string literal(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '\\':
        escaped += "\\e";
        break;
      case '-':
        escaped += "\\-";
        break;
      case '~':
        escaped += "\\(ti";
        break;
      case '^':
        escaped += "\\(ha";
        break;
      case '`':
        escaped += "\\(ga";
        break;
      case '\'':
        escaped += "\\(aq";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string bold(std::string_view text) {
  return "\\fB" + literal(text) + "\\fR";
}

std::string italic(std::string_view text) {
  return "\\fI" + literal(text) + "\\fR";
}

void ManualText::section(std::string_view name) {
  follows_heading_ = true;
  text_ += fmt::format(".SS \"{}\"\n", literal(name));
}

void ManualText::paragraph(std::string_view text) {
  if (text.empty()) return;
  if (!follows_heading_) text_ += ".PP\n";
  prose(text);
}

void ManualText::item(std::span<const std::string> tags, std::string_view text) {
  std::string_view macro = ".TP\n";
  for (const std::string& tag : tags) {
    text_ += fmt::format("{}{}\n", macro, tag);
    macro = ".TQ\n";
  }
  prose(text);
}

void ManualText::prose(std::string_view text) {
  follows_heading_ = false;
  std::istringstream words{std::string(text)};
  std::string line, word;
  bool is_literal = false;
  const auto flush = [&] {
    if (line.empty()) return;
    if (line[0] == '.') line.insert(0, "\\&");
    text_ += line + "\n";
    line.clear();
  };
  while (words >> word) {
    const std::string escaped = word_of_prose(word, is_literal);
    if (!line.empty() && line.size() + 1 + escaped.size() > kWidth) flush();
    if (!line.empty()) line += ' ';
    line += escaped;
    if (word.back() == '.' || word.back() == '?') flush();
  }
  flush();
}

std::string with_part(std::string page, std::string_view name, const std::string& text) {
  const std::string mark = fmt::format("@{}@\n", name);
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) {
    throw std::runtime_error(fmt::format("the page has no line @{}@", name));
  }
  return page.replace(at, mark.size(), text);
}

}  // namespace roundel
