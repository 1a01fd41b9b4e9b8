#include "tools/bug_report.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <doctest/doctest.h>

#include <filesystem>
#include <map>

#include "tests/child_process.hpp"
#include "tests/error_of.hpp"
#include "tests/file_size_limit.hpp"
#include "tests/random.hpp"
#include "tests/tools/run_roundel.hpp"
#include "tools/archive_writer.hpp"

using namespace roundel;

namespace {

std::map<std::string, std::string> files_of(const std::string& path) {
  std::map<std::string, std::string> files;
  archive* const reader = ::archive_read_new();
  ::archive_read_support_format_all(reader);
  ::archive_read_support_filter_all(reader);
  REQUIRE(::archive_read_open_filename(reader, path.c_str(), 65536) == ARCHIVE_OK);
  archive_entry* entry = nullptr;
  while (::archive_read_next_header(reader, &entry) == ARCHIVE_OK) {
    std::string text(static_cast<std::size_t>(::archive_entry_size(entry)), '\0');
    CHECK(::archive_read_data(reader, text.data(), text.size()) ==
          static_cast<la_ssize_t>(text.size()));
    files[::archive_entry_pathname(entry)] = text;
  }
  ::archive_read_free(reader);
  return files;
}

}  // namespace

TEST_CASE("secrets are taken out of what others will read") {
  CHECK(without_secrets("control:\n  token: abc def\n  group: roundel\n") ==
        "control:\n  token: (removed)\n  group: roundel\n");
  CHECK(without_secrets("web_token = \"x y\"") == "web_token = (removed)");
  CHECK(without_secrets("\"password\": \"x\"") == "\"password\": (removed)");
  CHECK(without_secrets("no secrets here") == "no secrets here");
  CHECK(without_secrets("token:\n") == "token:\n");
}

TEST_CASE("a report without a roundeld has what can be had, and says why the rest is missing") {
  const TemporaryDirectory folder;
  const std::string path = folder.file("report.zip");
  const CommandResult result =
      run_roundel("report --socket " + folder.file("none.sock") + " --config " +
                  folder.write("roundel.yaml", "lcm: {url: \"memq://\"}\n") + " -o " + path);
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  const auto files = files_of(path);
  CHECK(files.at("roundel.yaml") == "lcm: {url: \"memq://\"}\n");
  CHECK(contains(files.at("doctor.txt"), "configuration"));
  CHECK(contains(files.at("machine.txt"), "$ uname -a"));
  CHECK(contains(files.at("status.json.missing"), "roundeld can't be reached"));
  CHECK(files.count("status.json") == 0);
  CHECK(contains(result.out, "frames/            missing"));
  check_refused("report -o a.rar", 2, "no archive's name");
}

TEST_CASE("a report about a running roundeld has its state, a picture and frames") {
  const TemporaryDirectory folder;
  const std::string socket = folder.file("control.sock");
  const ChildProcess daemon(
      {ROUNDELD_BINARY, "--config",
       folder.write("roundel.yaml",
                    "simulator: {width: 640, height: 480, frame_rate: 20, robots: 2}\n"
                    "lcm: {url: \"memq://\"}\ncontrol: {group: \"\"}\n"),
       "--set", "control.socket=" + socket});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (run_roundel("snapshot -o - --socket " + socket).status != 0 &&
         std::chrono::steady_clock::now() < deadline) {
  }
  const auto session = [&] {
    return json_lines(run_roundel("status --json --socket " + socket).out)
        .front()["session"]
        .get<std::int64_t>();
  };
  std::int64_t before = 0;
  while (before == 0) before = session();  // until its first second is over
  const std::string path = folder.file("report.tar.gz");
  const CommandResult result = run_roundel("report --seconds 1 --socket " + socket + " -o " + path);
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  const auto files = files_of(path);
  CHECK(contains(files.at("in-use.yaml"), "url: \"memq://\""));
  CHECK(contains(files.at("status.json"), "\"frame_rate\""));
  CHECK(files.at("snapshot.jpg").starts_with("\xff\xd8"));
  CHECK(files.at("frames/frames.y4m").starts_with("YUV4MPEG2 W640 H480"));
  CHECK(contains(files.at("frames/poses.jsonl"), "\"markers\""));
  CHECK(contains(files.at("frames/replay.yaml"), "frames.y4m"));
  CHECK(contains(files.at("CONTENTS.txt"), "A PICTURE"));
  // Looking has not disturbed it.
  CHECK(session() == before);
}

TEST_CASE("an archive that the disk has no room for is an error that says so, and leaves nothing") {
  const TemporaryDirectory folder;
  const std::string path = folder.file("report.tar.gz");
  test::Random random(1);
  std::string noise(1 << 20, '\0');
  for (char& c : noise) c = static_cast<char>(random.integer(0, 255));
  const FileSizeLimit limit(100'000);
  const std::string error = error_of([&] {
    ArchiveWriter archive(path);
    archive.add("noise", noise);
    archive.close();
  });
  CHECK(contains(error, path + " can't be written"));
  CHECK(contains(error, "File too large"));  // as a full disk would be "No space left on device"
  CHECK_FALSE(std::filesystem::exists(path));
}
