#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "daemon/json_frame.hpp"
#include "tools/commands.hpp"
#include "tools/control_client.hpp"
#include "tools/doctor/examination.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

struct DoctorOptions {
  ExaminationOptions examination;
  bool json = false;
};

void doctor(const DoctorOptions& options) {
  const std::vector<Finding> findings = examine(options.examination);
  std::string text;
  for (const Finding& finding : findings) {
    text += options.json ? json_line(finding_json(finding)) : finding_text(finding);
  }
  print(text);
  const auto problems = std::count_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.verdict == Verdict::kProblem;
  });
  if (problems > 0) {
    throw std::runtime_error(fmt::format("{} problem{} found", problems, problems == 1 ? "" : "s"));
  }
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto* command = app.add_subcommand(
      "doctor",
      "Check network, camera, clock, calibrations and this machine, and say what to mend");
  const auto options = std::make_shared<DoctorOptions>();
  add_socket_option(*command, options->examination.socket);
  command
      ->add_option("--config", options->examination.config,
                   "Configuration to check (default: that of the running roundeld, else "
                   "/etc/roundel/roundel.yaml)")
      ->type_name("FILE");
  command->add_flag("--json", options->json, "One JSON object a check");
  command->footer("Ends with status 1 if there is a problem.");
  command->callback([options] { doctor(*options); });
}

}  // namespace roundel
