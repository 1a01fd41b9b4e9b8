// Long streaming: frames lost are counted and explained, memory does not grow.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <csignal>
#include <cstdlib>

#include "tests/lab/daemon_under_test.hpp"
#include "tests/lab/report.hpp"
#include "tests/lab/usb_camera.hpp"

using namespace roundel;

TEST_CASE("streaming for long drops nothing unexplained, and memory stays as it is") {
  constexpr int kPatienceMs = 20'000;
  const char* const wanted = std::getenv("ROUNDEL_LAB_SECONDS");
  const int seconds = wanted != nullptr ? std::atoi(wanted) : 20;
  const Film& film = Film::shared();
  UsbCameraDescription description;
  description.formats = {UsbFormat::kGrey};
  description.frame_rates = {15};
  UsbCamera camera(film, description);
  DaemonUnderTest daemon(film, {"camera.frame_rate=15"});
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  daemon.receive(2000);
  const long resident_kb = daemon.resident_kb(), anonymous_kb = daemon.anonymous_kb();
  const int descriptors = daemon.descriptors();
  const std::int64_t first = daemon.frames().back().header.frame;
  const std::int64_t sent = camera.frames_sent();
  std::int64_t received = 0, last = 0, dropped = 0;
  for (int second = 0; second < seconds; ++second) {
    daemon.forget();
    daemon.receive(1000);
    received += static_cast<std::int64_t>(daemon.frames().size());
    REQUIRE_FALSE(daemon.frames().empty());
    CHECK(fault_in(daemon.frames()) == "");
    last = daemon.frames().back().header.frame;
    dropped = daemon.frames().back().header.dropped;
    if (second % 60 == 59) {
      report(fmt::format("after {} s: {} kB resident, {} kB of them its own", second + 1,
                         daemon.resident_kb(), daemon.anonymous_kb()));
    }
  }
  const std::int64_t taken = last - first;
  CHECK(received + dropped == taken);
  CHECK(std::abs(camera.frames_sent() - sent - taken) <= 2);
  CHECK(daemon.anonymous_kb() <= anonymous_kb + 64);
  CHECK(daemon.resident_kb() <= resident_kb + 100);
  CHECK(daemon.descriptors() == descriptors);
  report(
      fmt::format("{} s: {} frames sent by the camera, {} published, {} dropped; resident {} kB, "
                  "then {} kB, its own {} kB, then {} kB",
                  seconds, camera.frames_sent() - sent, received, dropped, resident_kb,
                  daemon.resident_kb(), anonymous_kb, daemon.anonymous_kb()));
  daemon.process().signal(SIGTERM);
  CHECK(daemon.process().wait(std::chrono::seconds(5)) == 0);
  const std::string& log = daemon.log();
  report(log.substr(
      log.rfind("roundeld:", log.rfind("lost before they")),
      log.rfind("\nroundeld: ends") - log.rfind("roundeld:", log.rfind("lost before they"))));
}
