// Writes what is made from tables of the programs: manual pages and completions.
//   roundel_reference FOLDER_OF_TEMPLATES FOLDER_OF_LCM_TYPES OUTPUT_FOLDER VERSION DATE
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "config/default_yaml.hpp"
#include "daemon/command_line.hpp"
#include "packaging/reference/bash_completion.hpp"
#include "packaging/reference/command_pages.hpp"
#include "packaging/reference/configuration_page.hpp"
#include "packaging/reference/lcm_page.hpp"
#include "packaging/reference/manual_text.hpp"
#include "tools/commands.hpp"

namespace {

using std::filesystem::path;

std::string read_file(const path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(fmt::format("cannot read {}", file.string()));
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(fmt::format("cannot write {}", file.string()));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

void write_all(const path& templates, const path& types, const path& output,
               const std::string& version, const std::string& date) {
  using namespace roundel;  // NOLINT(google-build-using-namespace)
  CLI::App tool("", "roundel"), daemon("", "roundeld");
  add_commands(tool);
  CommandLine command_line;
  add_options(daemon, command_line);
  const auto tool_table = command_table(tool), daemon_table = command_table(daemon);

  const auto write_page = [&](const std::string& name, const char* part, const std::string& text) {
    std::string page = with_part(read_file(templates / (name + ".in")), part, text);
    page = replaced(replaced(page, "@VERSION@", version), "@DATE@", date);
    write_file(output / name, page);
  };
  write_page("roundel.1", "SUBCOMMANDS", subcommands_part("roundel", tool_table));
  write_page("roundeld.8", "OPTIONS", options_part(daemon_table.front()));
  write_page("roundel.yaml.5", "KEYS", keys_part(default_yaml()));
  std::string definitions;
  for (const char* type : {"frame_t", "pose_t", "status_t", "header_t", "marker_t", "latency_t"}) {
    definitions += read_file(types / (std::string(type) + ".lcm"));
  }
  write_page("roundel-lcm.5", "TYPES", types_part(definitions));
  write_file(output / "roundel.bash", bash_completion("roundel", tool_table));
  write_file(output / "roundeld.bash", bash_completion("roundeld", daemon_table));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    fmt::print(stderr, "usage: {} TEMPLATES TYPES OUTPUT VERSION DATE\n", argv[0]);
    return 2;
  }
  try {
    write_all(argv[1], argv[2], argv[3], argv[4], argv[5]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "roundel_reference: {}\n", error.what());
    return 1;
  }
  return 0;
}
