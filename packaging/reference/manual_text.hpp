#pragma once

#include <span>
#include <string>
#include <string_view>

namespace roundel {

// A part of a manual page in the man(7) macros. Text is prose: `this` in backquotes becomes bold,
// the rest is escaped as roff wants it, and lines are broken after sentences and before column 80.
class ManualText {
 public:
  void section(std::string_view name);     // .SS
  void paragraph(std::string_view prose);  // nothing if it is empty
  // Tags are roff already (bold() and so on); each on a line of its own, the text indented below.
  void item(std::span<const std::string> tags, std::string_view prose);

  const std::string& text() const { return text_; }

 private:
  void prose(std::string_view text);

  std::string text_;
  bool follows_heading_ = false;  // which makes a paragraph by itself
};

// Literal text as roff: what is to be typed. Hyphens stay what they are.
std::string literal(std::string_view text);
std::string bold(std::string_view text);
std::string italic(std::string_view text);

// A template with every line "@NAME@" replaced by `text`; throws std::runtime_error if there is
// none.
std::string with_part(std::string page, std::string_view name, const std::string& text);

}  // namespace roundel
