#include <doctest/doctest.h>

#include <csignal>

#include "tests/child_process.hpp"
#include "tests/private_network.hpp"
#include "tests/tools/run_roundel.hpp"

using namespace roundel;

namespace {

const std::string kUrl = "udpm://239.255.76.70:7710?ttl=0";

std::vector<std::string> small_arena(const std::vector<std::string>& more = {}) {
  std::vector<std::string> command = {ROUNDELD_BINARY};
  for (const char* setting : {"simulator.width=640", "simulator.height=480", "simulator.robots=2",
                              "simulator.clutter=false", "camera.name=east"}) {
    command.insert(command.end(), {"--set", setting});
  }
  command.insert(command.end(), {"--set", "lcm.url=" + kUrl});
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

}  // namespace

TEST_CASE("listen refuses a URL or a channel that can't be") {
  check_refused("listen --url tcp://x", 2, "--url: \"tcp://x\" is no usable LCM URL: unknown kind");
  check_refused("listen --url memq:// --channel 'A*'", 2, "--channel: \"A*\" is no channel prefix");
  check_refused("listen --seconds nonsense", 2, "--seconds");
}

TEST_CASE("listen ends with 1 and one line if no frame arrived") {
  check_refused("listen --url memq:// --seconds 0.01", 1, "no frame arrived on ROUNDEL_FRAME");
}

TEST_CASE("listen prints the frames of roundeld as JSON Lines of the documented form") {
  if (!multicast_is_private()) return;
  const ChildProcess daemon(small_arena());
  // The daemon may need a while, so frames are read until there is one with a pose.
  ChildProcess listen({ROUNDEL_BINARY, "listen", "--json", "--url", kUrl});
  REQUIRE(listen.wait_for("\"position\"", std::chrono::minutes(1)));
  REQUIRE(listen.wait_for("}\n", std::chrono::minutes(1)));
  listen.signal(SIGINT);
  REQUIRE(listen.wait(std::chrono::minutes(1)) == 0);
  const std::vector<nlohmann::json> frames = json_lines(listen.output());
  REQUIRE_FALSE(frames.empty());
  for (const nlohmann::json& frame : frames) {
    CHECK(frame["source"] == "east");
    CHECK(frame["frame"].is_number_integer());
    CHECK(frame["utime"].get<std::int64_t>() > 1'600'000'000'000'000);
    CHECK(frame["elapsed_us"].get<double>() > 0);
    CHECK(frame["receive_utime"].get<std::int64_t>() >= frame["publish_utime"].get<std::int64_t>());
    for (const nlohmann::json& marker : frame["markers"]) {
      CHECK(marker["position"].size() == 3);
      CHECK(marker["orientation"].size() == 4);
      CHECK(marker["track"].get<std::int64_t>() > 0);
    }
  }
}

TEST_CASE("listen shows a table with a row for every marker") {
  if (!multicast_is_private()) return;
  const ChildProcess daemon(small_arena());
  ChildProcess listen({ROUNDEL_BINARY, "listen", "--url", kUrl});
  REQUIRE(listen.wait_for("sigma mm", std::chrono::minutes(1)));
  REQUIRE(listen.wait_for("frames/s", std::chrono::minutes(1)));
  listen.signal(SIGINT);
  REQUIRE(listen.wait(std::chrono::minutes(1)) == 0);
  CHECK(contains(listen.output(), "east (simulated), 640x480, calibrated; frame "));
}
