// roundel compare as scripts use it: exit statuses, messages, figures; and the whole pipe.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/run_roundel.hpp"

namespace roundel {
namespace {

std::string truth_line(int frame, const std::string& markers) {
  return R"({"frame":)" + std::to_string(frame) + R"(,"utime":0,"markers":[)" + markers + "]}\n";
}

std::string truth_marker(int id, int u, bool visible = true) {
  return R"({"id":)" + std::to_string(id) + R"(,"kind":")" + (id > 0 ? "whycode" : "whycon") +
         R"(","visible":)" + (visible ? "true" : "false") + R"(,"u":)" + std::to_string(u) +
         R"(,"v":50,"position":[0.1,0,3],"orientation":[0,1,0,0]})";
}

std::string line(int frame, const std::string& markers) {
  return R"({"frame":)" + std::to_string(frame) + R"(,"markers":[)" + markers + "]}\n";
}

// 2 mm too far, with a sigma of 1, 1 and 4 mm.
std::string marker(int id, int u, int track) {
  return R"({"id":)" + std::to_string(id) + R"(,"track":)" + std::to_string(track) + R"(,"u":)" +
         std::to_string(u) + R"(,"v":50,"position":[0.1,0,3.002],"orientation":[0,1,0,0],)" +
         R"("sigma":{"position":[0.001,0.001,0.004],"rotation":[0.1,0.1,0.1]}})";
}

const std::string kTruth = truth_line(0, truth_marker(1, 100) + "," + truth_marker(-1, 200)) +
                           truth_line(1, truth_marker(1, 100) + "," + truth_marker(-1, 200));
const std::string kGood = line(0, marker(1, 100, 1) + "," + marker(-1, 200, 2)) +
                          line(1, marker(1, 100, 1) + "," + marker(-1, 200, 2));

// Both files in a folder of their own.
class Files {
 public:
  Files(const std::string& truth, const std::string& reported) {
    folder_.write("truth.jsonl", truth);
    folder_.write("found.jsonl", reported);
  }
  std::string command(const std::string& options = "") const {
    return "compare --truth " + folder_.file("truth.jsonl") + " " + folder_.file("found.jsonl") +
           " " + options;
  }

 private:
  TemporaryDirectory folder_;
};

void check_wrong(const std::string& truth, const std::string& reported, const std::string& words) {
  const Files files(truth, reported);
  check_refused(files.command(), 1, words);
}

// The table is printed, then one line names what failed.
void check_fails(const Files& files, const std::string& options, const std::string& words) {
  const CommandResult result = run_roundel(files.command(options));
  CAPTURE(options);
  CHECK(result.status == 1);
  CHECK(result.err == "roundel compare: " + words + "\n");
  CHECK(contains(result.out, "visible markers"));
}

}  // namespace

TEST_CASE("compare prints a table, and with --json one object") {
  const Files files(kTruth, kGood);
  const CommandResult table = run_roundel(files.command());
  CHECK(table.status == 0);
  CHECK(table.err == "");
  for (const char* words :
       {"2 frames", "found, %", "id swaps", "position error, mm", "honest: 68.3"}) {
    CAPTURE(words);
    CHECK(contains(table.out, words));
  }
  const CommandResult json = run_roundel(files.command("--json"));
  CHECK(json.status == 0);
  const auto lines = json_lines(json.out);
  REQUIRE(lines.size() == 1);
  const auto& all = lines[0];
  CHECK(all["frames"] == 2);
  CHECK(all["unanswered_frames"] == 0);
  CHECK(all["complete_frames"] == 2);
  CHECK(all["visible"] == 4);
  CHECK(all["found"] == 4);
  CHECK(all["found_percent"] == 100);
  CHECK(all["least_found_percent"] == 100);
  CHECK(all["not_in_truth"] == 0);
  CHECK(all["late_wrong_ids"] == 0);
  CHECK(all["swaps"] == 0);
  const auto& coded = all["coded"];
  CHECK(coded["visible"] == 2);
  CHECK(coded["missed"] == 0);
  CHECK(coded["wrong_ids"] == 0);
  CHECK(coded["position_error_mm"]["mean"] == doctest::Approx(2));
  CHECK(coded["orientation_error"]["worst"] == doctest::Approx(0));
  CHECK(coded["image_error_px"]["p99"] == doctest::Approx(0));
  CHECK(coded["within_one_sigma_percent"] == std::vector<double>{100, 100, 100});
  CHECK(coded["mean_square_error_over_sigma"][2] == doctest::Approx(0.25));
  CHECK(all["plain"]["orientation_error"].is_null());
  CHECK(all["plain"]["normal_error"]["median"] == doctest::Approx(0));
}

TEST_CASE("the report may come on standard input, and by detect without tracks") {
  const TemporaryDirectory folder;
  const std::string truth = folder.write("t", kTruth);
  const std::string found =
      folder.write("f", line(0, marker(1, 100, 0)) + line(1, marker(1, 100, 0)));
  const CommandResult result = run_roundel("compare --json --truth " + truth + " - <" + found);
  CHECK(result.status == 0);
  const auto lines = json_lines(result.out);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0]["found"] == 2);
  CHECK(lines[0]["swaps"].is_null());
  check_refused("compare --truth - -", 2, "can't both come on standard input");
  const CommandResult swaps = run_roundel("compare --max-swaps 0 --truth " + truth + " " + found);
  CHECK(swaps.status == 1);
  CHECK(contains(swaps.err, "has no track numbers"));
}

TEST_CASE("frames that were not answered count as missed") {
  const Files files(kTruth + truth_line(7, truth_marker(1, 1) + "," + truth_marker(-1, 200)),
                    line(1, marker(1, 100, 1)));
  const auto lines = json_lines(run_roundel(files.command("--json")).out);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0]["unanswered_frames"] == 2);
  CHECK(lines[0]["visible"] == 6);
  CHECK(lines[0]["found"] == 1);
  CHECK(lines[0]["least_found_percent"] == 0);
}

TEST_CASE("a threshold that is met changes nothing, one that is missed is named") {
  const std::string all =
      "--min-found 100 --min-complete 100 --max-wrong 0 --max-swaps 0 "
      "--max-false 0 ";
  CHECK(run_roundel(Files(kTruth, kGood).command(all)).status == 0);

  const Files missed(
      kTruth, line(0, marker(1, 100, 1) + "," + marker(-1, 200, 2)) + line(1, marker(1, 100, 1)));
  check_fails(missed, all,
              "visible markers found: 3 of 4 (75.000 %), less than 100 %; "
              "frames with all visible markers: 1 of 2 (50.000 %), less than 100 %");
  CHECK(run_roundel(missed.command("--min-found 75 --min-complete 50")).status == 0);

  const Files exchanged(kTruth, line(0, marker(1, 100, 1) + "," + marker(-1, 200, 2)) +
                                    line(1, marker(1, 100, 2) + "," + marker(-1, 200, 1)));
  check_fails(exchanged, all, "id swaps: 2, more than 0");
  CHECK(run_roundel(exchanged.command("--max-swaps 2")).status == 0);

  const Files extra(kTruth, kGood.substr(0, kGood.size() - 3) + "," + marker(9, 400, 3) + "]}\n");
  check_fails(extra, all, "markers not in the truth: 1, more than 0");
  CHECK(run_roundel(extra.command("--max-false 1")).status == 0);

  std::string truth, wrong;
  for (int i = 0; i < 4; ++i) {
    truth += truth_line(i, truth_marker(1, 100));
    wrong += line(i, marker(2, 100, 1));
  }
  check_fails(Files(truth, wrong), all,
              "wrong ids after the first 3 frames of a track: 1, more than 0");
}

TEST_CASE("a threshold on nothing is not met") {
  const Files nothing(truth_line(0, truth_marker(1, 100, false)), line(0, ""));
  check_fails(nothing, "--min-found 1", "visible markers found: there are none");
}

TEST_CASE("a bad line of either file is named by file and line") {
  check_wrong(kTruth, line(0, "") + "{\"frame\":1", "found.jsonl:2: is not JSON (character 11)");
  check_wrong(kTruth, line(0, "") + "{}\n", "found.jsonl:2: frame is missing");
  check_wrong(kTruth, line(0, "") + line(1, "{\"id\":1}"),
              "found.jsonl:2: markers[0]: u is missing");
  check_wrong(kTruth, line(0, "") + line(0, ""), "found.jsonl:2: frame 0 follows frame 0");
  check_wrong(kTruth, kGood + line(2, ""), "found.jsonl:3: frame 2 is not in ");
  check_wrong(truth_line(3, truth_marker(1, 1)), line(1, ""), "found.jsonl:1: frame 1 is not in ");
  check_wrong("[]\n", kGood, "truth.jsonl:1: no object");
  check_wrong(kTruth + "x\n", kGood, "truth.jsonl:3: is not JSON");
  check_wrong(kTruth + truth_line(2, truth_marker(5, 1)), kGood,
              "truth.jsonl:3: lists other markers");
  check_wrong(kTruth, std::string(9 << 20, ' '), "found.jsonl:1: is longer than");
}

TEST_CASE("files that are missing, empty or exchanged are refused") {
  check_wrong(kTruth, "", "found.jsonl is empty");
  check_wrong("", kGood, "truth.jsonl is empty");
  check_wrong(kGood, kTruth, "truth.jsonl:1: utime is missing");
  check_refused("compare --truth /nowhere/t /nowhere/f", 1, "/nowhere/f can't be opened");
  check_refused("compare --truth / /", 1, "can't be read: Is a directory");
  check_refused("compare x", 2, "--truth is required");
  check_refused("compare --truth x", 2, "FILE is required");
  check_refused("compare --truth x --min-found 101 y", 2, "--min-found");
  check_refused("compare --truth x --max-wrong -1 y", 2, "--max-wrong");
  const Files files(kTruth, kGood);
  check_refused(files.command(">/dev/full"), 1, "standard output can't be written");
}

// The writer gets past opening the pipe only once the reader waits for its first frame, and makes
// the other file only then: a reader that looks for it earlier fails.
TEST_CASE("track reads a camera file that is there no sooner than the first frame") {
  const TemporaryDirectory folder;
  REQUIRE(run_roundel("simulate --width 320 --height 180 --robots 1 --frames 2 --camera-out " +
                      folder.file("made.yaml") + " -o " + folder.file("made.y4m"))
              .status == 0);
  const std::string pipe = folder.file("pipe.y4m"), camera = folder.file("camera.yaml");
  REQUIRE(run_command("mkfifo " + pipe).status == 0);
  const CommandResult result = run_command(
      "timeout 60 sh -c 'exec 3>" + pipe + "; cp " + folder.file("made.yaml") + " " + camera +
      "; cat " + folder.file("made.y4m") +
      " >&3' & timeout 60 " ROUNDEL_BINARY " track --json --camera " + camera + " " + pipe);
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(json_lines(result.out).size() == 2);
}

TEST_CASE("compare reads a truth that is there no sooner than the first line of the report") {
  const TemporaryDirectory folder;
  const std::string pipe = folder.file("pipe"), truth = folder.file("truth.jsonl");
  REQUIRE(run_command("mkfifo " + pipe).status == 0);
  const CommandResult result =
      run_command("timeout 60 sh -c 'exec 3>" + pipe + "; cp " + folder.write("t", kTruth) + " " +
                  truth + "; cat " + folder.write("f", kGood) +
                  " >&3' & timeout 60 " ROUNDEL_BINARY " compare --truth " + truth + " " + pipe);
  CAPTURE(result.err);
  CHECK(result.status == 0);
}

TEST_CASE("parameters out of range are refused before a frame is waited for") {
  const TemporaryDirectory folder;
  REQUIRE(run_command("mkfifo " + folder.file("pipe.y4m")).status == 0);
  const CommandResult result =
      run_command("timeout 60 " ROUNDEL_BINARY " track --bits 17 " + folder.file("pipe.y4m"));
  CHECK(result.status == 2);
  CHECK(contains(result.err, "17 bits"));
}

TEST_CASE("simulate, track and compare work in one pipe, from nothing") {
  const TemporaryDirectory folder;
  const CommandResult result = run_command(
      "cd " + folder.file("") +
      " && " ROUNDEL_BINARY
      " simulate --width 960 --height 540 --robots 4 --diameter 0.2 --frames 20 --camera-out "
      "camera.yaml --truth truth.jsonl -o - | " ROUNDEL_BINARY
      " track --camera camera.yaml --diameter 0.2 --json - | " ROUNDEL_BINARY
      " compare --json --truth truth.jsonl --min-found 99.9 --max-wrong 0 --max-swaps 0 -");
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(result.err == "");
  const auto lines = json_lines(result.out);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0]["frames"] == 20);
  CHECK(lines[0]["unanswered_frames"] == 0);
  CHECK(lines[0]["coded"]["visible"] >= 60);
  CHECK(lines[0]["coded"]["position_error_mm"]["mean"] < 3.0);
}

}  // namespace roundel
