#include "packaging/reference/configuration_page.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "config/fields.hpp"
#include "packaging/reference/commented_lines.hpp"
#include "packaging/reference/manual_text.hpp"

namespace roundel {
namespace {

// Keys that one comment is about: the first has it, those that follow have none of their own.
class SharedComment {
 public:
  explicit SharedComment(ManualText& part) : part_(part) {}

  void add(const std::string& key, const std::string& value, const std::string& comment) {
    const Field* const field = find_field(key);
    if (field == nullptr) throw std::runtime_error(key + " is no key of the configuration");
    const std::string accepts = fmt::format("Accepts {}.", accepted_values(*field));
    if (!comment.empty() || accepts != accepts_) end();
    if (!comment.empty()) comment_ = comment + ". ";
    tags_.push_back(bold(key + ":") + " " + literal(value));
    accepts_ = accepts;
  }

  void end() {
    if (!tags_.empty()) part_.item(tags_, comment_ + accepts_);
    tags_.clear();
    comment_.clear();
    accepts_.clear();
  }

 private:
  ManualText& part_;
  std::vector<std::string> tags_;
  std::string comment_, accepts_;
};

}  // namespace

std::string keys_part(std::string_view yaml) {
  ManualText part;
  SharedComment items(part);
  std::string section;
  for (const CommentedLine& line : commented_lines(yaml, "#")) {
    const std::size_t colon = line.code.find(':');
    const std::string name = line.code.substr(0, colon);
    const bool has_value = colon + 1 < line.code.size();
    if (line.code.empty() || line.indentation == 0 || !line.before.empty()) items.end();
    if (line.code.empty()) {
      if (!section.empty()) part.paragraph(line.comment);  // else the head of the file
      continue;
    }
    if (line.indentation == 0) {
      section = name;
      part.section(name);
    }
    part.paragraph(line.before);
    if (!has_value) continue;
    const std::string value = line.code.substr(line.code.find_first_not_of(' ', colon + 1));
    items.add(line.indentation == 0 ? name : fmt::format("{}.{}", section, name), value,
              line.comment);
  }
  items.end();
  return part.text();
}

}  // namespace roundel
