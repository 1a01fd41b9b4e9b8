#include "tools/bug_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>
#include <stdexcept>

#include "tools/doctor/examination.hpp"
#include "tools/recording_run.hpp"

namespace roundel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInstalledConfiguration = "/etc/roundel/roundel.yaml";
constexpr std::size_t kMostOutput = std::size_t{4} << 20;

// A folder that is gone, with what is in it, afterwards.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "roundel-report-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string configuration_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(fmt::format("{} can't be read", path));
  return without_secrets(std::string(std::istreambuf_iterator<char>(file), {}));
}

std::string doctor_text(const BugReportOptions& options) {
  std::string text;
  for (const Finding& finding : examine({options.socket, options.config, {}})) {
    text += finding_text(finding);
  }
  return text;
}

std::string machine_text() {
  std::string text = fmt::format("roundel {}\n", ROUNDEL_VERSION);
  for (const char* command :
       {"uname -a", "cat /etc/os-release", "cat /proc/cpuinfo | grep -m 3 -i model", "free -m",
        "uptime", "df -h /var/lib /tmp", "ip -brief address", "ip route", "lsusb",
        "dpkg-query -W 'roundel*' liblcm1 libmicrohttpd12"}) {
    text += fmt::format("\n$ {}\n{}", command, output_of(command));
  }
  return text;
}

void add_recording(ArchiveWriter& archive, const ControlClient& client, double seconds) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "frames";
  RecordingLimits limits;
  limits.seconds = seconds;
  limits.keep_tracks = true;  // who looks shall not disturb
  run_recording(client, folder.string(), limits, [] { return true; });
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    archive.add_file("frames/" + entry.path().filename().string(), entry.path().string());
  }
}

}  // namespace

std::string without_secrets(std::string_view text) {
  static const std::regex secret(R"((token|password|secret)(["']?\s*[:=]\s*)\S[^\n]*)",
                                 std::regex::icase);
  return std::regex_replace(std::string(text), secret, "$1$2(removed)");
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(
      ::popen(("{ " + command + "; } 2>&1 </dev/null").c_str(), "re"), ::pclose);
  if (!pipe) return "can't be run\n";
  std::string text;
  std::array<char, 65536> block{};
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), pipe.get())) {
    text.append(block.data(), size);
    if (text.size() > 2 * kMostOutput) text.erase(0, text.size() - kMostOutput);
  }
  return text;
}

std::vector<std::string> fill_bug_report(ArchiveWriter& archive, const BugReportOptions& options) {
  const ControlClient client(options.socket);
  std::vector<std::string> contents;
  const auto add = [&](const char* name, const char* what,
                       const std::function<std::string()>& make) {
    try {
      archive.add(name, make());
      contents.push_back(fmt::format("{:<18} {}", name, what));
    } catch (const std::runtime_error& error) {
      const std::string note = std::string(name) + ".missing";
      archive.add(note, std::string(error.what()) + "\n");
      contents.push_back(fmt::format("{:<18} why there is no {}: {}", note, name, error.what()));
    }
  };
  const auto get = [&](const char* path) {
    return [&, path] { return client.request("GET", path); };
  };

  add("doctor.txt", "what roundel doctor says", [&] { return doctor_text(options); });
  add("machine.txt", "versions, processor, memory, disks, network addresses, USB devices",
      machine_text);
  add("roundel.yaml", "the configuration file", [&] {
    return configuration_text(options.config.empty() ? kInstalledConfiguration : options.config);
  });
  add("in-use.yaml", "the configuration in use", [&] {
    return without_secrets(
        client.get("/v1/configuration").value("yaml", std::string("roundeld did not tell\n")));
  });
  add("log.txt", "the last 2000 lines of roundeld's log", [] {
    return without_secrets(output_of("journalctl --no-pager -o short-iso -n 2000 -u 'roundeld*'"));
  });
  add("status.json", "how roundeld was doing", get("/v1/status"));
  add("calibration.json", "the arena's calibration", get("/v1/calibration"));
  add("controls.json", "the camera's controls", get("/v1/controls"));
  add("snapshot.jpg", "A PICTURE of the arena", get("/v1/frame.jpg"));
  if (options.seconds <= 0) return contents;
  try {
    add_recording(archive, client, options.seconds);
    contents.push_back(
        fmt::format("{:<18} PICTURES: {} seconds of frames, with poses and calibrations", "frames/",
                    options.seconds));
  } catch (const std::runtime_error& error) {
    contents.push_back(fmt::format("{:<18} missing: {}", "frames/", error.what()));
  }
  return contents;
}

}  // namespace roundel
