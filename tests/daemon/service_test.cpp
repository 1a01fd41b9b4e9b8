// What systemd is told, at the other end of its socket.
#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>

#include "daemon/service/service_report.hpp"
#include "daemon/service/service_status.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/daemon/notify_socket.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

constexpr auto kPatience = 10s;
constexpr std::int64_t kSecondNs = 1'000'000'000;

// Of this process, for as long as it lives.
class EnvironmentVariable {
 public:
  EnvironmentVariable(const char* name, const std::string& value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~EnvironmentVariable() { ::unsetenv(name_); }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  const char* name_;
};

// Remembers what it was to send.
class NotedLink final : public ServiceLink {
 public:
  NotedLink(std::vector<std::string>& sent, std::int64_t watchdog_ns)
      : sent_(sent), watchdog_ns_(watchdog_ns) {}
  void send(const char* lines) override { sent_.emplace_back(lines); }
  std::int64_t watchdog_ns() const override { return watchdog_ns_; }

 private:
  std::vector<std::string>& sent_;
  std::int64_t watchdog_ns_;
};

struct Noted {
  explicit Noted(std::int64_t watchdog_ns = 0)
      : report(std::make_unique<NotedLink>(sent, watchdog_ns)) {}
  std::vector<std::string> sent;
  ServiceReport report;
};

using Lines = std::vector<std::string>;

std::string text_of(const ServiceStatus& status) {
  fmt::memory_buffer text;
  write_status(status, text);
  return fmt::to_string(text);
}

}  // namespace

TEST_CASE("what is sent arrives at NOTIFY_SOCKET as it is") {
  NotifySocket systemd;
  REQUIRE(systemd.bound());
  const EnvironmentVariable variable("NOTIFY_SOCKET", systemd.path());
  const auto link = service_manager();
  link->send("READY=1");
  link->send("STATUS=Tracking");
  CHECK(systemd.receive(kPatience) == "READY=1");
  CHECK(systemd.receive(kPatience) == "STATUS=Tracking");
  CHECK(link->watchdog_ns() == 0);
}

TEST_CASE("the watchdog's period is the one in the environment, if it is meant for this process") {
  NotifySocket systemd;
  const EnvironmentVariable variable("NOTIFY_SOCKET", systemd.path());
  const EnvironmentVariable period("WATCHDOG_USEC", "2500000");
  CHECK(service_manager()->watchdog_ns() == 2'500'000'000);
  {
    const EnvironmentVariable ours("WATCHDOG_PID", std::to_string(::getpid()));
    CHECK(service_manager()->watchdog_ns() == 2'500'000'000);
  }
  const EnvironmentVariable others("WATCHDOG_PID", "1");
  CHECK(service_manager()->watchdog_ns() == 0);
}

TEST_CASE("without a service manager nothing is asked for and nothing happens") {
  const EnvironmentVariable period("WATCHDOG_USEC", "2500000");
  const auto link = service_manager();
  CHECK(link->watchdog_ns() == 0);
  link->send("READY=1");
}

TEST_CASE("readiness is told once, a status whenever it differs") {
  Noted noted;
  noted.report.status("Starting: a camera");
  CHECK_FALSE(noted.report.is_ready());
  noted.report.ready();
  CHECK(noted.report.is_ready());
  noted.report.ready();
  noted.report.status("Starting: a camera");
  noted.report.status("Tracking\n10 frames/s");
  noted.report.status("Tracking\n10 frames/s");
  noted.report.status("Tracking");
  noted.report.stopping();
  CHECK(noted.sent == Lines{"STATUS=Starting: a camera", "READY=1", "STATUS=Tracking 10 frames/s",
                            "STATUS=Tracking", "STOPPING=1"});
}

TEST_CASE("a reload is told with the time it begins, and ends ready") {
  Noted noted;
  noted.report.ready();
  noted.report.begin_reload(123456);
  noted.report.end_reload();
  CHECK(noted.sent == Lines{"READY=1", "RELOADING=1\nMONOTONIC_USEC=123456", "READY=1"});
}

TEST_CASE("a reload before the first frame does not make it ready") {
  Noted noted;
  noted.report.begin_reload(1);
  noted.report.end_reload();
  CHECK(noted.sent.empty());
  CHECK_FALSE(noted.report.is_ready());
}

TEST_CASE("signs of life go out four times in the watchdog's period, however often there are any") {
  Noted noted(2 * kSecondNs);
  for (int ms = 0; ms < 2000; ++ms) noted.report.alive(kSecondNs + ms * 1'000'000);
  CHECK(noted.sent == Lines(4, "WATCHDOG=1"));
}

TEST_CASE("the loop wakes up for the next sign of life, and sleeps on if it had none to give") {
  Noted noted(2 * kSecondNs);
  noted.report.alive(kSecondNs);
  CHECK(noted.report.sleep_ms(kSecondNs) == 500);
  CHECK(noted.report.sleep_ms(kSecondNs + 499'500'000) == 1);
  CHECK(noted.report.sleep_ms(kSecondNs + 500'000'000) == 500);
  CHECK(noted.report.sleep_ms(9 * kSecondNs) == 500);
}

TEST_CASE("without a watchdog the loop sleeps as long as it likes and gives no signs") {
  Noted noted;
  noted.report.alive(kSecondNs);
  CHECK(noted.report.sleep_ms(kSecondNs) == -1);
  CHECK(noted.sent.empty());
}

TEST_CASE("telling a status that has been told before does not allocate") {
  NotifySocket systemd;
  const EnvironmentVariable variable("NOTIFY_SOCKET", systemd.path());
  ServiceReport report(service_manager());
  SteadyRate rate;
  fmt::memory_buffer text;
  ServiceStatus status;
  status.camera = CameraState::kStreaming;
  status.source = "simulator 1920x1080 at 30 frames/s, 12 robots";
  const auto tell = [&](double frame_rate) {
    status.frame_rate = rate.steady(frame_rate);
    write_status(status, text);
    report.status({text.data(), text.size()});
  };
  tell(30);
  const AllocationCounter counter;
  tell(29.7);
  tell(15);
  CHECK(counter.count() == 0);
}

TEST_CASE("the status says what a person asks first") {
  ServiceStatus status;
  status.source = "a camera, not there yet";
  CHECK(text_of(status) == "Starting: a camera, not there yet");
  status.waits_because = "there is no camera that can capture";
  CHECK(text_of(status) == "Waits for the camera: there is no camera that can capture");
  status.camera = CameraState::kLost;
  CHECK(text_of(status) == "Lost the camera, waits for it: there is no camera that can capture");
  status.camera = CameraState::kStreaming;
  status.source = "C270: GREY 640x480";
  CHECK(text_of(status) ==
        "Tracking C270: GREY 640x480; lens not calibrated: no poses; arena not calibrated");
  status.frame_rate = 29.8;
  status.calibration = CalibrationState::kValid;
  status.arena = ArenaState::kMoved;
  CHECK(text_of(status) ==
        "Tracking 30 frames/s from C270: GREY 640x480; lens calibrated; the camera has been moved "
        "since the arena was calibrated");
  status.arena = ArenaState::kValid;
  status.network = false;
  status.url = "udpm://";
  status.reload_error = "a.yaml:3:1: no";
  CHECK(text_of(status) ==
        "Tracking 30 frames/s from C270: GREY 640x480; lens calibrated; arena calibrated; no "
        "network for poses to udpm:// yet; the last reload failed: a.yaml:3:1: no");
}

TEST_CASE("a frame rate is shown anew only when it has really changed") {
  SteadyRate rate;
  CHECK(rate.steady(30) == 30);
  CHECK(rate.steady(29.2) == 30);
  CHECK(rate.steady(31.4) == 30);
  CHECK(rate.steady(27) == 27);
  CHECK(rate.steady(0) == 0);
}
