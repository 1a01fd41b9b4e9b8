// A camera is calibrated by what a running roundeld sees: somebody shows a board to it.
#include <doctest/doctest.h>

#include <cmath>
#include <csignal>
#include <filesystem>

#include "calibration/camera_file.hpp"
#include "tests/child_process.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A roundeld whose camera sees a board that is held still in one place after another.
class BoardRig {
 public:
  BoardRig(int views, bool loop) {
    REQUIRE(run_program({ROUNDEL_BINARY, "simulate", "--board", "--width", "640", "--height", "360",
                         "--noise", "2", "--frames", std::to_string(views), "--camera-out", truth(),
                         "-o", folder_.file("views")})
                .status == 0);
    std::string paths;
    for (int i = 0; i < views; ++i) {
      char name[32];
      std::snprintf(name, sizeof name, "views/frame_%06d.png", i);
      REQUIRE(std::filesystem::exists(folder_.file(name)));
      for (int repeated = 0; repeated < 4; ++repeated) paths += folder_.file(name) + ", ";
    }
    daemon_.emplace(std::vector<std::string>{
        ROUNDELD_BINARY, "--config",
        folder_.write("roundel.yaml",
                      "source: files\nfiles: {paths: [" + paths + "], frame_rate: 20, loop: " +
                          (loop ? "true" : "false") + "}\nlcm: {url: \"memq://\"}\n" +
                          "arena: {file: " + folder_.file("arena.yaml") +
                          "}\ncontrol: {socket: " + socket() + ", group: \"\"}\n")});
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (run_program({ROUNDEL_BINARY, "status", "--socket", socket()}).status != 0) {
      REQUIRE(std::chrono::steady_clock::now() < deadline);
    }
  }

  std::string socket() const { return folder_.file("control.sock"); }
  std::string truth() const { return folder_.file("true.yaml"); }
  std::string result() const { return folder_.file("camera.yaml"); }

  std::vector<std::string> command(std::vector<std::string> more) const {
    std::vector<std::string> all = {ROUNDEL_BINARY, "calibrate", "camera", "--socket", socket()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

 private:
  TemporaryDirectory folder_;
  std::optional<ChildProcess> daemon_;
};

}  // namespace

TEST_CASE("a board shown to a running roundeld becomes a camera file, with guidance on the way") {
  const BoardRig rig(25, true);
  const Finished made = run_program(rig.command({"-o", rig.result(), "--time-limit", "40"}));
  CAPTURE(made.errors);
  CAPTURE(made.output);
  REQUIRE(made.status == 0);
  CHECK(has(made.errors, "Show the board to the camera"));
  CHECK(has(made.errors, "view 1: "));
  CHECK(has(made.errors, "move it to these parts of the picture"));
  CHECK(has(made.errors, "view 15: "));
  CHECK(has(made.output, "total error 0.0"));
  const CameraModel found = read_camera_file(rig.result()).camera;
  const CameraModel truth = read_camera_file(rig.truth()).camera;
  CHECK(std::abs(found.fx / truth.fx - 1) < 0.001);
  CHECK(std::abs(found.fy / truth.fy - 1) < 0.001);
  CHECK(std::abs(found.cx - truth.cx) < 1);
  CHECK(std::abs(found.cy - truth.cy) < 1);
}

TEST_CASE("Ctrl-C ends the collection, and what is missing is said") {
  const BoardRig rig(3, true);
  ChildProcess tool(rig.command({"-o", rig.result()}));
  REQUIRE(tool.wait_for("view 3: ", 60s));
  tool.signal(SIGINT);
  CHECK(tool.wait(60s) == 1);
  CHECK(has(tool.errors(), "at least 5"));
  CHECK_FALSE(std::filesystem::exists(rig.result()));
}

TEST_CASE("where the file can't be written is said before anything is collected") {
  const TemporaryDirectory folder;
  const Finished refused = run_program({ROUNDEL_BINARY, "calibrate", "camera", "--socket",
                                        folder.file("none"), "-o", folder.file("no/camera.yaml")});
  CHECK(refused.status == 1);
  CHECK(has(refused.errors, "no/camera.yaml"));
  const Finished nobody =
      run_program({ROUNDEL_BINARY, "calibrate", "camera", "--socket", folder.file("none")});
  CHECK(nobody.status == 1);
  CHECK(has(nobody.errors, "roundeld can't be reached"));
}
