#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <memory>

#include "tools/bug_report.hpp"
#include "tools/commands.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

struct ReportOptions {
  BugReportOptions contents;
  std::string output;  // empty: named by the time
};

void report(const ReportOptions& options) {
  const std::string path = options.output.empty()
                               ? fmt::format("roundel-report-{:%Y%m%d-%H%M%S}.tar.gz",
                                             fmt::localtime(std::time(nullptr)))
                               : options.output;
  if (!path.ends_with(".tar.gz") && !path.ends_with(".zip")) {
    throw UsageError(fmt::format("{} is no archive's name: use FILE.tar.gz or FILE.zip", path));
  }
  ArchiveWriter archive(path);
  std::string text;
  for (const std::string& line : fill_bug_report(archive, options.contents)) {
    text += "  " + line + "\n";
  }
  archive.add("CONTENTS.txt", text);
  archive.close();
  print(fmt::format("{}, {:.1f} MB. Look into it before you give it away:\n{}", path,
                    static_cast<double>(std::filesystem::file_size(path)) / 1e6, text));
}

}  // namespace

void add_report(CLI::App& app) {
  auto* command = app.add_subcommand(
      "report",
      "Pack configuration, state, log, a picture and a few seconds of frames for a bug report");
  const auto options = std::make_shared<ReportOptions>();
  add_socket_option(*command, options->contents.socket);
  command->add_option("-o,--output", options->output, "FILE.tar.gz or FILE.zip (default: by time)")
      ->type_name("FILE");
  command
      ->add_option("--config", options->contents.config,
                   "Configuration file (default: /etc/roundel/roundel.yaml)")
      ->type_name("FILE");
  command->add_option("--seconds", options->contents.seconds, "Of frames; 0: no frames")
      ->check(CLI::Range(0.0, 60.0))
      ->type_name("N")
      ->capture_default_str();
  command->callback([options] { report(*options); });
}

}  // namespace roundel
