#include <memory>
#include <string>

#include "tools/commands.hpp"
#include "tools/json_lines.hpp"
#include "tools/pose_csv.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

void export_csv(const std::string& path) {
  JsonLines lines(path);
  print(pose_csv_heading());
  while (const auto frame = lines.next()) {
    std::string rows;
    try {
      rows = pose_csv_rows(*frame);
    } catch (const std::runtime_error& error) {
      lines.fail(error.what());
    }
    print(rows);
  }
}

}  // namespace

void add_export(CLI::App& app) {
  auto* command = app.add_subcommand(
      "export", "Poses as CSV: from the JSON Lines of track, detect, listen and record");
  const auto path = std::make_shared<std::string>();
  command->add_option("FILE", *path, "JSON Lines; - for standard input")->required();
  command->footer(
      "One row a marker, in the order of the file; a frame without markers has a row with empty "
      "fields. The names of the columns end with their units. What a marker does not have (no "
      "pose, no arena) is empty.");
  command->callback([path] { export_csv(*path); });
}

}  // namespace roundel
