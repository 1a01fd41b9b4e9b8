// Recording a running roundeld, and playing what was recorded.
#include <doctest/doctest.h>

#include <filesystem>

#include "daemon/y4m.hpp"
#include "tests/child_process.hpp"
#include "tests/tools/run_roundel.hpp"
#include "transport/messages.hpp"
#include "transport/subscriber.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

using Json = nlohmann::json;

// A roundeld on a small simulated arena.
class Rig {
 public:
  Rig()
      : daemon_({ROUNDELD_BINARY, "--config", folder_.write("roundel.yaml", kYaml), "--set",
                 "control.socket=" + socket()}) {
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (run({"snapshot", "-o", "-"}).status != 0 &&
           std::chrono::steady_clock::now() < deadline) {
    }
  }

  std::string socket() const { return folder_.file("control.sock"); }
  std::string file(const std::string& name) const { return folder_.file(name); }

  Finished run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), ROUNDEL_BINARY);
    arguments.insert(arguments.end(), {"--socket", socket()});
    return run_program(arguments);
  }

 private:
  static constexpr const char* kYaml =
      "simulator: {width: 640, height: 480, frame_rate: 25, robots: 4, clutter: false}\n"
      "camera: {name: north}\nlcm: {url: \"memq://\"}\ncontrol: {group: \"\"}\n";
  TemporaryDirectory folder_;
  ChildProcess daemon_;
};

std::vector<Json> lines_of(const std::string& file) {
  return json_lines(read_file(file));
}

// The frames that a roundeld published into a log file, as (number, time) and markers.
std::vector<ReceivedFrame> frames_of_log(const std::string& path) {
  Subscriber subscriber("file://" + path + "?speed=0", "ROUNDEL");
  std::vector<ReceivedFrame> frames;
  try {
    while (const ReceivedFrame* frame = subscriber.next_frame(10s)) frames.push_back(*frame);
  } catch (const std::runtime_error&) {  // the log has ended
  }
  return frames;
}

std::vector<ReceivedFrame> replay(const std::string& recording, const std::string& log) {
  const std::string command = "cd " + recording + " && " + ROUNDELD_BINARY +
                              " --config replay.yaml --set files.frame_rate=0 --set "
                              "'lcm.url=file://" +
                              log + "?mode=w'";
  const CommandResult played = run_command(command);
  CAPTURE(played.err);
  REQUIRE(played.status == 0);
  return frames_of_log(log);
}

// What was published of a marker, against the JSON of the recording: single precision.
void check_same(const marker_t& published, const Json& recorded) {
  CHECK(published.id == recorded["id"]);
  CHECK(published.track == recorded["track"]);
  CHECK(published.u == static_cast<float>(recorded["u"].get<double>()));
  CHECK(published.v == static_cast<float>(recorded["v"].get<double>()));
  REQUIRE(published.has_pose != 0);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(published.position[i] == static_cast<float>(recorded["position"][i].get<double>()));
  }
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(published.orientation[i] == static_cast<float>(recorded["orientation"][i].get<double>()));
  }
}

}  // namespace

TEST_CASE("a recording gives the same poses again, bit for bit, by roundel track and by roundeld") {
  const Rig rig;
  const std::string recording = rig.file("run");
  const Finished recorded = rig.run({"record", "--frames", "20", "-o", recording});
  CAPTURE(recorded.errors);
  REQUIRE(recorded.status == 0);
  CHECK(contains(recorded.errors, "20 frames in "));

  const std::vector<Json> poses = lines_of(recording + "/poses.jsonl");
  REQUIRE(poses.size() == 20);
  const CommandResult tracked = run_roundel("track --json --camera " + recording + "/camera.yaml " +
                                            recording + "/frames.y4m");
  CAPTURE(tracked.err);
  REQUIRE(tracked.status == 0);
  const std::vector<Json> again = json_lines(tracked.out);
  REQUIRE(again.size() == poses.size());
  std::size_t markers = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    CHECK(poses[i]["source"] == "north");
    CHECK(again[i]["frame"] == poses[i]["frame"]);
    CHECK(again[i]["utime"] == poses[i]["utime"]);
    CHECK(again[i]["markers"] == poses[i]["markers"]);
    CHECK(poses[i]["unrecorded"] == 0);
    markers += poses[i]["markers"].size();
  }
  CHECK(markers > 4 * poses.size());

  const std::vector<ReceivedFrame> first = replay(recording, rig.file("first.log"));
  const std::vector<ReceivedFrame> second = replay(recording, rig.file("second.log"));
  REQUIRE(first.size() == poses.size());
  REQUIRE(second.size() == poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    REQUIRE(first[i].markers.size() == poses[i]["markers"].size());
    REQUIRE(second[i].markers.size() == first[i].markers.size());
    for (std::size_t m = 0; m < first[i].markers.size(); ++m) {
      check_same(first[i].markers[m], poses[i]["markers"][m]);
      check_same(second[i].markers[m], poses[i]["markers"][m]);
    }
  }
}

TEST_CASE("the tracks go on through a recording that is asked to keep them") {
  const Rig rig;
  std::int64_t before = 0;
  while (before == 0) {  // until its first second is over
    before = json_lines(rig.run({"status", "--json"}).output).front()["session"];
  }
  REQUIRE(rig.run({"record", "--keep-tracks", "--frames", "2", "-o", rig.file("kept")}).status ==
          0);
  CHECK(lines_of(rig.file("kept/poses.jsonl")).back()["session"] == before);
  REQUIRE(rig.run({"record", "--frames", "2", "-o", rig.file("new")}).status == 0);
  CHECK(lines_of(rig.file("new/poses.jsonl")).back()["session"] > before);
}

TEST_CASE("one recording at a time, into a folder of its own, until Ctrl-C") {
  const Rig rig;
  ChildProcess first({ROUNDEL_BINARY, "record", "-o", rig.file("a"), "--socket", rig.socket()});
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (!std::filesystem::exists(rig.file("a/frames.y4m")) &&
         std::chrono::steady_clock::now() < deadline) {
  }
  const Finished second = rig.run({"record", "-o", rig.file("b")});
  CHECK(second.status == 1);
  CHECK(contains(second.errors, "somebody else is recording"));
  CHECK_FALSE(std::filesystem::exists(rig.file("b")));
  first.signal(SIGINT);
  CHECK(first.wait(60s) == 0);

  const Finished same = rig.run({"record", "-o", rig.file("a")});
  CHECK(same.status == 1);
  CHECK(contains(same.errors, "/a is not empty"));
}

TEST_CASE("a recording that finds no room ends whole, and says so") {
  const Rig rig;
  // The kernel refuses what is beyond a file's limit as it refuses what a full disk can't take.
  const CommandResult full =
      run_command("ulimit -f 1200; exec " ROUNDEL_BINARY " record --frames 20 -o " +
                  rig.file("full") + " --socket " + rig.socket());
  CHECK(full.status == 1);
  CHECK(contains(full.err, "frames.y4m can't be written: File too large"));
  const std::vector<Json> poses = lines_of(rig.file("full/poses.jsonl"));
  REQUIRE_FALSE(poses.empty());
  CHECK(poses.size() < 20);
  Y4mReader video(rig.file("full/frames.y4m"));
  GreyImage frame;
  while (video.next(frame)) {
  }
  CHECK(video.frames_read() == static_cast<std::int64_t>(poses.size()));
}
