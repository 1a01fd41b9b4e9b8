#include "packaging/reference/command_table.hpp"

#include <algorithm>
#include <sstream>

namespace roundel {
namespace {

// CLI11 tells value and checks in one text: "METRES:FLOAT in [0.001 - 5]", "TEXT:{pdf,svg,png}".
void read_type(std::string_view type, OptionEntry& entry) {
  const std::size_t end = type.find(':');
  entry.value = type.substr(0, end);
  if (end == std::string_view::npos) return;
  const std::string_view checks = type.substr(end + 1);
  if (const auto open = checks.find('['), close = checks.find(']'); close != checks.npos) {
    entry.range = checks.substr(open + 1, close - open - 1);
    if (const auto dash = entry.range.find(" - "); dash != std::string::npos) {
      entry.range.replace(dash, 3, " to ");
    }
  } else if (checks.starts_with('{') && checks.ends_with('}')) {
    std::istringstream list{std::string(checks.substr(1, checks.size() - 2))};
    for (std::string choice; std::getline(list, choice, ',');) entry.choices.push_back(choice);
  }
}

OptionEntry entry_of(const CLI::Option& option, const std::string& group) {
  OptionEntry entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  if (option.get_items_expected_max() > 0) read_type(option.get_type_name(), entry);
  if (option.get_positional()) entry.value = option.get_name(true);
  entry.value_is_optional = option.get_items_expected_max() > 0 && option.get_expected_min() == 0;
  entry.repeated = option.get_expected_max() > 1;
  entry.default_value = option.get_default_str();
  entry.description = option.get_description();
  entry.group = group;
  entry.required = option.get_required();
  entry.environment = option.get_envname();
  for (const CLI::Option* needed : option.get_needs()) entry.needs = needed->get_name();
  return entry;
}

// Options of the command and of its groups, which CLI11 keeps as commands without a name.
void add_options_of(const CLI::App& app, const std::string& group, CommandEntry& command) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty() || option == app.get_help_ptr()) continue;
    (option->get_positional() ? command.arguments : command.options)
        .push_back(entry_of(*option, group));
  }
  for (const CLI::App* part : app.get_subcommands({})) {
    if (part->get_name().empty()) add_options_of(*part, part->get_group(), command);
  }
}

void add_command(const CLI::App& app, const std::string& path, std::vector<CommandEntry>& table) {
  CommandEntry command{path, app.get_description(), {}, {}, {}};
  add_options_of(app, "", command);
  for (const CLI::App* below : app.get_subcommands({})) {
    if (!below->get_name().empty()) command.subcommands.push_back(below->get_name());
  }
  table.push_back(command);
  for (const CLI::App* below : app.get_subcommands({})) {
    if (below->get_name().empty()) continue;
    add_command(*below, path + (path.empty() ? "" : " ") + below->get_name(), table);
  }
}

}  // namespace

bool OptionEntry::takes_file() const {
  return value.find("FILE") != std::string::npos || value.find("PATH") != std::string::npos ||
         value.find("DIRECTORY") != std::string::npos;
}

std::vector<CommandEntry> command_table(const CLI::App& program) {
  std::vector<CommandEntry> table;
  add_command(program, "", table);
  return table;
}

}  // namespace roundel
