#include "tools/doctor/examination.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>

#include "config/reader.hpp"
#include "daemon/broadcast_targets.hpp"
#include "daemon/json_fields.hpp"
#include "daemon/statistics.hpp"
#include "tools/doctor/calibration_checks.hpp"
#include "tools/doctor/camera_checks.hpp"
#include "tools/doctor/daemon_checks.hpp"
#include "tools/doctor/machine_checks.hpp"
#include "tools/doctor/network_checks.hpp"
#include "transport/lcm_url.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kInstalledConfiguration = "/etc/roundel/roundel.yaml";
constexpr std::chrono::milliseconds kLoopbackPatience{1000};
constexpr std::size_t kUsualMarkers = 30;

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "ok";
    case Verdict::kWarning:
      return "warning";
    case Verdict::kProblem:
      return "problem";
  }
  return "";
}

// What a running roundeld says; nothing if there is none.
struct Running {
  std::optional<Json> status;
  std::string configuration;  // YAML
};

Running ask_daemon(const std::string& socket, std::vector<Finding>& findings) {
  try {
    const ControlClient client(socket);
    Running running{client.get("/v1/status"),
                    string_field(client.get("/v1/configuration"), "yaml")};
    findings.push_back({"roundeld", Verdict::kOk,
                        fmt::format("version {} runs", string_field(*running.status, "version")),
                        ""});
    return running;
  } catch (const std::runtime_error& error) {
    findings.push_back({"roundeld", Verdict::kWarning, error.what(),
                        "systemctl status roundeld tells more; what only a running roundeld knows "
                        "is not checked"});
    return {};
  }
}

LoadedConfiguration load_configuration(const ExaminationOptions& options, const Running& running,
                                       std::vector<Finding>& findings) {
  try {
    LoadedConfiguration loaded = !options.config.empty() ? read_configuration(options.config)
                                 : !running.configuration.empty()
                                     ? parse_configuration(running.configuration, "roundeld's")
                                 : options.root.exists(kInstalledConfiguration)
                                     ? read_configuration(options.root.of(kInstalledConfiguration))
                                     : default_configuration();
    BroadcastTargets::check_url(loaded.values.lcm);
    findings.push_back({"configuration", Verdict::kOk, loaded.name, ""});
    return loaded;
  } catch (const std::runtime_error& error) {
    findings.push_back({"configuration", Verdict::kProblem, error.what(),
                        "mend the file; the rest is checked for the default"});
    return default_configuration();
  }
}

std::vector<std::string> group_names() {
  constexpr int kMost = 256;
  std::vector<gid_t> groups(kMost);
  const int count = ::getgroups(kMost, groups.data());
  groups.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
  groups.push_back(::getegid());
  std::vector<std::string> names;
  for (const gid_t id : groups) {
    if (const group* entry = ::getgrgid(id); entry != nullptr) names.emplace_back(entry->gr_name);
  }
  return names;
}

// Where the arena's calibration is, or would be.
Finding disk_finding(const std::string& file) {
  std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  std::error_code error;
  while (!std::filesystem::exists(folder, error) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  struct statvfs space {};
  if (::statvfs(folder.c_str(), &space) != 0) {
    return {"disk", Verdict::kWarning, fmt::format("{} can't be looked at", folder.string()), ""};
  }
  return check_disk({folder.string(), static_cast<std::int64_t>(space.f_bavail) *
                                          static_cast<std::int64_t>(space.f_frsize)});
}

}  // namespace

std::vector<Finding> examine(const ExaminationOptions& options) {
  std::vector<Finding> findings;
  const auto add = [&](std::vector<Finding> more) {
    findings.insert(findings.end(), std::make_move_iterator(more.begin()),
                    std::make_move_iterator(more.end()));
  };
  const MachineRoot& root = options.root;
  const Running running = ask_daemon(options.socket, findings);
  const LoadedConfiguration configuration = load_configuration(options, running, findings);
  const Configuration& values = configuration.values;
  std::size_t markers = kUsualMarkers;
  int width = 0, height = 0;
  if (running.status) {
    const Json& camera = field(*running.status, "camera");
    width = static_cast<int>(number_field(camera, "width"));
    height = static_cast<int>(number_field(camera, "height"));
    markers = std::max(markers, static_cast<std::size_t>(number_field(*running.status, "markers")));
    add(check_status(*running.status, values));
  }
  add(check_camera(root, kernel_cameras(), configuration));
  add({check_lens(values, width, height, std::chrono::system_clock::now()), check_arena(values)});
  const LcmUrl url = parse_lcm_url(values.lcm.url);
  const Route route =
      url.provider == LcmUrl::Provider::kUdp ? find_route(url.address, url.port) : Route();
  add({check_url(values.lcm), check_route(values.lcm, route),
       check_interface(root, values.lcm, route), check_firewall(root, values.lcm),
       check_buffers(root, markers), check_loopback(values.lcm, kLoopbackPatience)});
  add({check_clock(root, clock_state()),
       check_groups(group_names(), values.control.group, ::geteuid() == 0),
       disk_finding(values.arena.file), check_temperature(root)});
  add(check_throttling(root));
  return findings;
}

std::string finding_text(const Finding& finding) {
  return fmt::format("{:<8} {:<13} {}{}{}\n", name_of(finding.verdict), finding.check, finding.text,
                     finding.remedy.empty() ? "" : "; to mend: ", finding.remedy);
}

Json finding_json(const Finding& finding) {
  return {{"check", finding.check},
          {"verdict", name_of(finding.verdict)},
          {"text", finding.text},
          {"remedy", finding.remedy}};
}

}  // namespace roundel
