#include "packaging/reference/command_pages.hpp"

#include <fmt/format.h>

#include "packaging/reference/manual_text.hpp"

namespace roundel {
namespace {

std::string tag_of(const OptionEntry& option) {
  std::string tag;
  for (const std::string& name : option.names) tag += (tag.empty() ? "" : ", ") + bold(name);
  if (option.value.empty()) return tag;
  std::string value = italic(option.value);
  if (!option.choices.empty()) {
    value.clear();
    for (const std::string& choice : option.choices) {
      value += (value.empty() ? "" : "|") + bold(choice);
    }
  }
  if (option.value_is_optional) value = "[" + value + "]";
  return tag + (tag.empty() ? "" : " ") + value +
         (option.names.empty() && option.repeated ? "..." : "");
}

std::string sentence(const std::string& text) {
  return text.empty() || text.back() == '.' ? text : text + ".";
}

std::string prose_of(const OptionEntry& option) {
  std::string prose = sentence(option.description);
  if (!option.group.empty()) prose += fmt::format(" (Of {}.)", option.group);
  if (!option.range.empty()) prose += fmt::format(" From {}.", option.range);
  if (!option.needs.empty()) prose += fmt::format(" Only with `{}`.", option.needs);
  if (!option.default_value.empty()) prose += fmt::format(" Default: {}.", option.default_value);
  if (!option.environment.empty()) {
    prose += fmt::format(" Also by the environment: `{}`.", option.environment);
  }
  if (option.required && !option.names.empty()) prose += " Must be given.";
  return prose;
}

void add_items(const std::vector<OptionEntry>& options, ManualText& part) {
  for (const OptionEntry& option : options) {
    const std::string tag = tag_of(option);
    part.item({&tag, 1}, prose_of(option));
  }
}

}  // namespace

std::string options_part(const CommandEntry& command) {
  ManualText part;
  add_items(command.arguments, part);
  add_items(command.options, part);
  return part.text();
}

std::string subcommands_part(const std::string& program, const std::vector<CommandEntry>& table) {
  ManualText part;
  for (const CommandEntry& command : table) {
    if (command.path.empty() || !command.subcommands.empty()) continue;
    part.section(program + " " + command.path);
    part.paragraph(sentence(command.description));
    add_items(command.arguments, part);
    add_items(command.options, part);
  }
  return part.text();
}

}  // namespace roundel
