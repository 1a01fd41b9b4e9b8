// The subcommands that talk to roundeld, against a real one.
#include <doctest/doctest.h>

#include "calibration/arena_file.hpp"
#include "tests/child_process.hpp"
#include "tests/slow_build.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A roundeld on a small simulated arena.
class Rig {
 public:
  Rig()
      : daemon_(
            {ROUNDELD_BINARY, "--config",
             folder_.write("roundel.yaml",
                           "simulator: {width: 960, height: 540, frame_rate: 20, robots: 2, "
                           "clutter: false}\nlcm: {url: \"memq://\"}\narena: {file: " +
                               file() + "}\ncontrol: {socket: " + socket() + ", group: \"\"}\n")}) {
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (run({"status"}).status != 0 && std::chrono::steady_clock::now() < deadline) {
    }
  }

  std::string socket() const { return folder_.file("control.sock"); }
  std::string file() const { return folder_.file("arena.yaml"); }
  const TemporaryDirectory& folder() const { return folder_; }

  Finished run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), ROUNDEL_BINARY);
    arguments.insert(arguments.end(), {"--socket", socket()});
    return run_program(arguments);
  }

 private:
  TemporaryDirectory folder_;
  ChildProcess daemon_;
};

}  // namespace

TEST_CASE("roundel calibrates, restores, looks, tells and reloads by a running roundeld") {
  const Rig rig;
  const Finished calibrated =
      rig.run({"calibrate", "arena", "--width", "3", "--height", "2", "--time-limit", "60"});
  CAPTURE(calibrated.errors);
  REQUIRE(calibrated.status == 0);
  CHECK(has(calibrated.output, "Arena of 3 x 2 m, certain to 0.0"));
  CHECK(has(calibrated.output, "corner plain   at (3.000, 2.000) m"));
  REQUIRE(ArenaStore(rig.file()).load().has_value());

  const Finished status = rig.run({"status"});
  CHECK(status.status == 0);
  CHECK(has(status.output, "simulator 960x540"));
  CHECK(has(status.output, "arena        calibrated on"));
  CHECK(has(rig.run({"status", "--json"}).output, "\"state\":\"valid\""));

  const std::string picture = rig.folder().file("a.png");
  CHECK(rig.run({"snapshot", "-o", picture}).status == 0);
  CHECK(read_file(picture).starts_with("\x89PNG"));
  CHECK(rig.run({"snapshot", "-o", "a.bmp"}).status == 2);

  CHECK(has(rig.run({"controls"}).output, "no controls"));
  CHECK(rig.run({"controls", "gain=3"}).status == 1);
  CHECK(rig.run({"controls", "gain"}).status == 2);

  CHECK(has(rig.run({"calibrate", "restore"}).errors, "no calibration before"));
  CHECK(rig.run({"reload"}).status == 0);
  rig.folder().write("roundel.yaml", "marker: {bits: 1}\n");
  const Finished reload = rig.run({"reload"});
  CHECK(reload.status == 1);
  CHECK(has(reload.errors, "marker.bits"));
}

TEST_CASE("a wrong size is refused with status 1 and the numbers") {
  const Rig rig;
  // Twenty frames must come in that time.
  const Finished refused = rig.run({"calibrate", "arena", "--width", "3", "--height", "3",
                                    "--time-limit", test::kSlow ? "20" : "2"});
  CHECK(refused.status == 1);
  CHECK(has(refused.errors, "no rectangle of 3 x 3 m"));
  CHECK(refused.output.empty());
  CHECK_FALSE(ArenaStore(rig.file()).load().has_value());
}

TEST_CASE("options of calibrate arena that make no sense are refused") {
  const TemporaryDirectory folder;
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> command = {ROUNDEL_BINARY, "calibrate", "arena", "--socket",
                                        folder.file("none")};
    command.insert(command.end(), more.begin(), more.end());
    return run_program(command);
  };
  CHECK(run({"--width", "3"}).status == 2);
  CHECK(run({"--width", "3", "--height", "2", "--origin", "middle"}).status == 2);
  CHECK(run({"--width", "3", "--height", "2", "--anchor", "9=1"}).status == 2);
  const Finished nobody = run({"--width", "3", "--height", "2"});
  CHECK(nobody.status == 1);
  CHECK(has(nobody.errors, "roundeld can't be reached"));
}
