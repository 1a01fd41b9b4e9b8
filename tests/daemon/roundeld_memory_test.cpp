// What roundeld takes of a small computer's memory, and that it takes no more as time goes by.
#include <doctest/doctest.h>

#include <csignal>

#include "tests/child_process.hpp"
#include "tests/private_network.hpp"
#include "tests/slow_build.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/subscriber.hpp"

using namespace roundel;
using namespace std::chrono_literals;

TEST_CASE("at Full HD with a hundred markers roundeld takes 40 MB at most, and no more later") {
  // Sanitizers have memory of their own.
  if (!multicast_is_private() || test::kSlow) return;
  constexpr long kLimitKb = 40'000;
  constexpr long kLeastFrames = 20;
  // Some buffer may meet its largest marker only now; anything lost per frame would be more.
  constexpr long kScratchKb = 300;
  const std::string url = "udpm://239.255.76.69:7741?ttl=0";
  const TemporaryDirectory folder;
  const std::string path = folder.write(
      "roundel.yaml",
      "simulator: {width: 1920, height: 1080, frame_rate: 30, robots: 96, corner_markers: true, "
      "noise: 3}\nmarker: {bits: 10}\nlcm: {url: \"" +
          url + "\"}\n");
  Subscriber subscriber(url, "ROUNDEL");
  ChildProcess daemon({ROUNDELD_BINARY, "--config", path});
  long frames = 0, settled_kb = 0, last_kb = 0;
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (frames < 4 * kLeastFrames && std::chrono::steady_clock::now() < deadline) {
    const ReceivedFrame* const frame = subscriber.next_frame(1s);
    if (frame == nullptr || frame->markers.size() < 95) continue;
    ++frames;
    last_kb = daemon.memory_kb("VmRSS:");
    if (frames == 2 * kLeastFrames) settled_kb = last_kb;
  }
  REQUIRE(frames == 4 * kLeastFrames);
  MESSAGE(settled_kb << " kB resident, then " << last_kb << " kB");
  CHECK(settled_kb > 1000);
  CHECK(last_kb <= kLimitKb);
  CHECK(last_kb <= settled_kb + kScratchKb);
  daemon.signal(SIGTERM);
  CHECK(daemon.wait(60s) == 0);
}
