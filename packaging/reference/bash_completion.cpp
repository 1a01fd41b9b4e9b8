#include "packaging/reference/bash_completion.hpp"

#include <fmt/format.h>

#include "config/fields.hpp"

namespace roundel {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
  return fmt::format("{}", fmt::join(words, between));
}

// "true false" and the like where a key accepts few words; empty where it doesn't.
std::string words_of(const Field& field) {
  Configuration any;
  const FieldTarget target = field.target(any);
  const bool is_choice = std::holds_alternative<bool*>(target) ||
                         std::holds_alternative<SourceKind*>(target) || field.key == "arena.mode";
  if (!is_choice) return {};
  std::string words;
  for (const char c : accepted_values(field)) {
    if (c != ',') words += c;
  }
  return words;
}

std::string key_function(const std::string& name) {
  std::string keys, values;
  for (const Field& field : fields()) {
    keys += fmt::format("{}=", field.key) + " ";
    if (const std::string words = words_of(field); !words.empty()) {
      values += fmt::format("    {}) _{}_words '{}' ;;\n", field.key, name, words);
    }
  }
  return fmt::format(
      "# A key of the configuration, or the value of the key $1 if that is known.\n"
      "_{0}_keys() {{\n"
      "  case $1 in\n"
      "    '') compopt -o nospace 2>/dev/null\n"
      "      _{0}_words '{1}' ;;\n"
      "{2}"
      "    *) _{0}_files ;;\n"
      "  esac\n"
      "}}\n\n",
      name, keys, values);
}

// What may stand behind an option: "detect --camera) _roundel_files ;;".
std::string value_cases(const std::string& name, const CommandEntry& command) {
  std::string cases;
  for (const OptionEntry& option : command.options) {
    if (option.value.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& option_name : option.names) {
      patterns.push_back(
          fmt::format("'{}{}{}'", command.path, command.path.empty() ? "" : " ", option_name));
    }
    std::string action = ":";
    if (!option.choices.empty()) {
      action = fmt::format("_{}_words '{}'", name, joined(option.choices, " "));
    } else if (option.value == "KEY=VALUE") {
      action = fmt::format("_{}_keys ''", name);
    } else if (option.takes_file()) {
      action = fmt::format("_{}_files", name);
    }
    cases += fmt::format("    {}) {}\n      return ;;\n", joined(patterns, " | "), action);
  }
  return cases;
}

std::string word_case(const CommandEntry& command) {
  std::vector<std::string> words = command.subcommands;
  for (const OptionEntry& option : command.options) {
    words.insert(words.end(), option.names.begin(), option.names.end());
  }
  words.emplace_back("--help");
  const bool takes_files = !command.arguments.empty() && command.arguments.front().takes_file();
  return fmt::format("    '{}') words='{}' files={} ;;\n", command.path, joined(words, " "),
                     takes_files ? "yes" : "");
}

}  // namespace

std::string bash_completion(const std::string& program, const std::vector<CommandEntry>& table) {
  std::string commands, values, words;
  bool has_keys = false;
  for (const CommandEntry& command : table) {
    if (!command.path.empty()) commands += (commands.empty() ? "'" : " | '") + command.path + "'";
    values += value_cases(program, command);
    words += word_case(command);
    for (const OptionEntry& option : command.options) has_keys |= option.value == "KEY=VALUE";
  }
  std::string script =
      fmt::format("# Completion of {} for bash, made from its table of options.\n\n", program);
  script += fmt::format(
      "_{0}_words() {{\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$current\")\n"
      "}}\n\n"
      "_{0}_files() {{\n"
      "  compopt -o filenames 2>/dev/null\n"
      "  mapfile -t COMPREPLY < <(compgen -f -- \"$current\")\n"
      "}}\n\n",
      program);
  if (has_keys) script += key_function(program);
  script += fmt::format(
      "_{0}() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
      "  local path='' longer words='' files='' i\n"
      "  COMPREPLY=()\n",
      program);
  if (!commands.empty()) {
    script += fmt::format(
        "  for ((i = 1; i < COMP_CWORD; i++)); do\n"
        "    longer=${{path:+$path }}${{COMP_WORDS[i]}}\n"
        "    case $longer in\n"
        "      {}) path=$longer ;;\n"
        "    esac\n"
        "  done\n",
        commands);
  }
  if (has_keys) {
    script += fmt::format(
        "  # KEY=VALUE is three words to bash.\n"
        "  if [[ $before == = ]]; then\n"
        "    _{0}_keys \"${{COMP_WORDS[COMP_CWORD - 2]}}\"\n"
        "    return\n"
        "  elif [[ $current == = ]]; then\n"
        "    current=''\n"
        "    _{0}_keys \"$before\"\n"
        "    return\n"
        "  fi\n",
        program);
  }
  script += fmt::format(
      "  case ${{path:+$path }}$before in\n"
      "{1}"
      "  esac\n"
      "  case $path in\n"
      "{2}"
      "  esac\n"
      "  if [[ $current == -* || -z $files ]]; then\n"
      "    _{0}_words \"$words\"\n"
      "  else\n"
      "    _{0}_files\n"
      "  fi\n"
      "}}\n"
      "complete -F _{0} {0}\n",
      program, values, words);
  return script;
}

}  // namespace roundel
