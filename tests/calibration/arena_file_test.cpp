#include "calibration/arena_file.hpp"

#include <doctest/doctest.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <iterator>

#include "tests/calibration/arena_scene.hpp"
#include "tests/error_of.hpp"
#include "tests/file_size_limit.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;
using namespace roundel::test;

namespace {

ArenaCalibration sample(const std::string& date = "2026-11-22T09:00:00Z") {
  ArenaScene scene;
  ArenaRequest request = three_by_two();
  request.origin = ArenaOrigin::kBottomLeft;
  request.anchors = {{21, 1.5, 0.25}};
  const auto frame = [&](int) {
    std::vector<Marker> markers = plain_corners(scene);
    markers.push_back(scene.marker(21, {1.5, 0.25, 0}));
    return markers;
  };
  ArenaCalibration calibration = shown(scene, request, frame).result();
  calibration.camera.identity = "usb \"Cam\"\\ 1: 4-2\n";
  calibration.camera.crop = "0,0 1920x1080";
  calibration.date = date;
  calibration.version = "0.1.0";
  return calibration;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t place = text.find(what);
  REQUIRE(place != std::string::npos);
  return text.replace(place, what.size(), by);
}

// Runs a task in a child and kills the child when it enters its system call number `calls` (from
// 0). Returns whether it was killed; false if it finished before. The numbers of the calls are
// appended to `made`.
template <typename Task>
bool killed_at_call(int calls, Task&& task, std::vector<long>* made = nullptr) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    ::raise(SIGSTOP);
    try {
      task();
    } catch (...) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFSTOPPED(status));
  for (int stops = 0;; ++stops) {
    REQUIRE(::ptrace(PTRACE_SYSCALL, child, nullptr, nullptr) == 0);
    REQUIRE(::waitpid(child, &status, 0) == child);
    if (WIFEXITED(status)) {
      REQUIRE(WEXITSTATUS(status) == 0);
      return false;
    }
    REQUIRE(WIFSTOPPED(status));
    if (stops % 2 != 0) continue;  // the call returns
    if (made != nullptr) {
#if defined(__x86_64__)
      user_regs_struct registers{};
      REQUIRE(::ptrace(PTRACE_GETREGS, child, nullptr, &registers) == 0);
      made->push_back(static_cast<long>(registers.orig_rax));
#endif
    }
    if (stops / 2 < calls) continue;
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    return true;
  }
}

constexpr int kEndless = 1'000'000;

}  // namespace

TEST_CASE("an arena calibration reads back as it was written") {
  const ArenaCalibration written = sample();
  const ArenaCalibration read = parse_arena_file(format_arena_file(written), "arena.yaml");
  CHECK(format_arena_file(read) == format_arena_file(written));
  CHECK(read.arena_in_camera.position == written.arena_in_camera.position);
  CHECK(read.arena_in_camera.orientation.coeffs() == written.arena_in_camera.orientation.coeffs());
  CHECK(read.covariance == written.covariance);
  CHECK(read.camera.identity == written.camera.identity);
  CHECK(read.references.size() == 5);
  CHECK(read.request.anchors.size() == 1);
  CHECK(mismatch(read.camera, written.camera).empty());
}

TEST_CASE("a damaged calibration is refused with its place") {
  const std::string good = format_arena_file(sample());
  const auto error = [&](const std::string& what, const std::string& by) {
    return error_of([&] { parse_arena_file(replaced(good, what, by), "arena.yaml"); });
  };
  CHECK(error("format: 1", "format: 2") == "arena.yaml:3:9: this version reads format 1 only");
  CHECK(error("  fx: 1000", "  fx: 0").find("fx must be a number from") != std::string::npos);
  CHECK(error("  width: 3\n", "").find("width is missing") != std::string::npos);
  CHECK(error("orientation: [", "orientation: [2, ").find("list of 4") != std::string::npos);
  CHECK(error("bottom-left", "middle").find("origin must be one of") != std::string::npos);
  CHECK(error("covariance: [", "covariance: [.nan, ").find("36 numbers") != std::string::npos);
  CHECK(error("  frames: 40", "  frames: .inf").find("frames") != std::string::npos);
  CHECK(error("result:", "nothing:").find("result is missing") != std::string::npos);
  CHECK_FALSE(error_of([] { parse_arena_file("", "a"); }).empty());
  CHECK_FALSE(error_of([] { parse_arena_file("[1, 2]", "a"); }).empty());
}

TEST_CASE("a calibration cut short or garbled at any byte never does worse than an error") {
  const std::string good = format_arena_file(sample());
  Random random(1);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string text =
        good.substr(0, static_cast<std::size_t>(random.integer(0, static_cast<int>(good.size()))));
    for (int k = 0; k < 3 && !text.empty(); ++k) {
      text[static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1))] =
          static_cast<char>(random.integer(0, 255));
    }
    refused += error_of([&] { parse_arena_file(text, "a"); }).empty() ? 0 : 1;
  }
  CHECK(refused > 350);
}

TEST_CASE("a calibration of another camera, resolution, crop or lens does not match") {
  const ArenaCamera camera = ArenaScene().arena_camera();
  const auto why = [&](auto&& change) {
    ArenaCamera other = camera;
    change(other);
    return mismatch(camera, other);
  };
  CHECK(why([](ArenaCamera&) {}).empty());
  CHECK(why([](ArenaCamera& c) { c.identity = "other"; }) ==
        "it belongs to the camera \"test camera\", this is \"other\"");
  CHECK(why([](ArenaCamera& c) { c.intrinsics.width = 1280; }) ==
        "it was made at 1920x1080 pixels, this is 1280x1080");
  CHECK(why([](ArenaCamera& c) { c.crop = "8,8 1904x1064"; }) ==
        "it was made with another part of the sensor (all, now 8,8 1904x1064)");
  CHECK(why([](ArenaCamera& c) { c.intrinsics.fx += 1; }) ==
        "the camera has been calibrated anew since it was made");
}

TEST_CASE("the store keeps the calibration before, and brings it back") {
  const TemporaryDirectory folder;
  ArenaStore store(folder.file("arena.yaml"));
  CHECK_FALSE(store.load().has_value());
  CHECK(error_of([&] { store.restore(); }).find("no calibration before") != std::string::npos);
  store.save(sample("one"));
  store.save(sample("two"));
  CHECK(store.load()->date == "two");
  CHECK(store.restore().date == "one");
  CHECK(store.load()->date == "one");
  CHECK(store.restore().date == "two");
  CHECK(store.forget());
  CHECK_FALSE(store.load().has_value());
  CHECK_FALSE(store.forget());
  CHECK(store.restore().date == "two");
}

TEST_CASE("a damaged calibration is replaced, and does not push out the one before it") {
  const TemporaryDirectory folder;
  ArenaStore store(folder.file("arena.yaml"));
  store.save(sample("one"));
  store.save(sample("two"));
  for (const std::string& damaged : {std::string("width: ["), std::string(1 << 20, 'x')}) {
    folder.write("arena.yaml", damaged);
    store.save(sample("three"));
    CHECK(store.load()->date == "three");
    folder.write("arena.yaml", damaged);
    CHECK(store.restore().date == "one");
    CHECK(store.load()->date == "one");
    folder.write("arena.yaml", damaged);
  }
}

TEST_CASE("a damaged calibration that is put aside does not push out the one before it") {
  const TemporaryDirectory folder;
  ArenaStore store(folder.file("arena.yaml"));
  store.save(sample("one"));
  store.save(sample("two"));
  folder.write("arena.yaml", "width: [");
  store.forget();
  CHECK_FALSE(store.load().has_value());
  CHECK(store.restore().date == "one");
}

TEST_CASE("on a full disk the calibration in use and the one before stay what they are") {
  const TemporaryDirectory folder;
  ArenaStore store(folder.file("arena.yaml"));
  store.save(sample("first"));
  store.save(sample("second"));
  const auto check_both = [&](const std::string& current, const std::string& before) {
    CHECK(store.load()->date == current);
    CHECK(read_arena_file(store.previous_path()).date == before);
    CHECK(std::distance(std::filesystem::directory_iterator(folder.file("")), {}) == 2);
  };
  {
    // Room for a file as large as the old one, none for the new one.
    const FileSizeLimit limit(format_arena_file(sample("second")).size() + 1);
    CHECK(error_of([&] { store.save(sample("third, much longer")); }).find("can't be written") !=
          std::string::npos);
    check_both("second", "first");
  }
  store.save(sample("third, much longer"));
  {
    // The other way round: room for the one that is restored, none for the one that makes way.
    const FileSizeLimit limit(format_arena_file(sample("second")).size() + 1);
    CHECK_FALSE(error_of([&] { store.restore(); }).empty());
    check_both("third, much longer", "second");
  }
  CHECK(store.restore().date == "second");
  check_both("second", "third, much longer");
}

TEST_CASE("killed at any system call of saving, the store has a whole calibration") {
  const ArenaCalibration first = sample("first"), second = sample("second"),
                         third = sample("third");
  const auto prepare = [&](ArenaStore& store) {
    store.save(first);
    store.save(second);
  };
  int kills = 0, old = 0, fresh = 0;
  for (;; ++kills) {
    const TemporaryDirectory folder;
    ArenaStore store(folder.file("arena.yaml"));
    prepare(store);
    const bool killed = killed_at_call(kills, [&] { store.save(third); });
    const auto current = store.load();
    REQUIRE(current.has_value());
    (current->date == "third" ? fresh : old) += 1;
    CHECK((current->date == "second" || current->date == "third"));
    const std::string before = read_arena_file(store.previous_path()).date;
    CHECK((before == "first" || before == "second"));
    if (current->date == "third") CHECK(before == "second");
    // What was left behind does not keep the next one from being saved, and goes away with it.
    store.save(third);
    CHECK(store.load()->date == "third");
    CHECK(std::distance(std::filesystem::directory_iterator(folder.file("")), {}) == 2);
    if (!killed) break;
    REQUIRE(kills < kEndless);
  }
  CHECK(kills >= 10);
  CHECK(old > 0);
  CHECK(fresh > 0);
  MESSAGE(kills << " system calls; the old one was there after " << old
                << " kills, the new one after " << fresh);
}

#if defined(__x86_64__)
TEST_CASE("a calibration is synced before it takes its place, and its folder after") {
  const TemporaryDirectory folder;
  ArenaStore store(folder.file("arena.yaml"));
  std::vector<long> calls;
  CHECK_FALSE(killed_at_call(
      kEndless, [&] { store.save(sample("one")); }, &calls));
  std::vector<long> kept;  // of interest, in order
  for (const long call : calls) {
    if (call == SYS_write || call == SYS_fsync || call == SYS_rename) kept.push_back(call);
  }
  CHECK(kept == std::vector<long>{SYS_write, SYS_fsync, SYS_rename, SYS_fsync});
}
#endif
