#include "daemon/files_source.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "tests/daemon/wait_for_descriptor.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/clock.hpp"

using namespace roundel;

namespace {

constexpr int kTimeoutMs = 10000;

// A PGM of one grey.
std::string pgm(int width, int height, char grey) {
  return "P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n" +
         std::string(static_cast<std::size_t>(width * height), grey);
}

std::string y4m(int frames, char first_grey) {
  std::string text = "YUV4MPEG2 W4 H2 F30:1 Cmono\n";
  for (int i = 0; i < frames; ++i) {
    text += "FRAME\n" + std::string(8, static_cast<char>(first_grey + i));
  }
  return text;
}

struct Played {
  std::vector<int> greys;
  std::vector<std::int64_t> numbers;
};

// Plays to the end, or as many frames.
Played play(FilesSource& source, std::size_t most = 1000) {
  Played played;
  while (source.state() != CameraState::kEnded && played.greys.size() < most) {
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    const auto lease = source.next();
    if (!lease) continue;
    played.greys.push_back(lease->frame().luma.at(0, 0));
    played.numbers.push_back(lease->frame().number);
    CHECK(lease->frame().stamp_source == StampSource::kArrival);
  }
  return played;
}

}  // namespace

TEST_CASE("images, folders and videos are played in order, without leaving any out") {
  const TemporaryDirectory folder;
  const std::string image = folder.write("z.pgm", pgm(4, 2, 10));
  const std::string video = folder.write("v.y4m", y4m(3, 20));
  const TemporaryDirectory images;
  images.write("b.pgm", pgm(4, 2, 31));
  images.write("a.PGM", pgm(4, 2, 30));
  images.write("notes.txt", "not an image");
  FilesSource source({{image, video, images.file(""), image}, 0, false});
  CHECK(source.width() == 4);
  CHECK(source.height() == 2);
  const Played played = play(source);
  CHECK(played.greys == std::vector<int>{10, 20, 21, 22, 30, 31, 10});
  CHECK(played.numbers == std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6});
  CHECK(source.complete());
  CHECK(source.dropped() == 0);
  CHECK_FALSE(source.next().has_value());
}

TEST_CASE("a loop starts again at the first file") {
  const TemporaryDirectory folder;
  FilesSource source(
      {{folder.write("a.pgm", pgm(2, 2, 1)), folder.write("b.y4m", y4m(1, 2))}, 0, true});
  CHECK(play(source, 5).greys == std::vector<int>{1, 2, 1, 2, 1});
  CHECK(source.state() == CameraState::kStreaming);
}

TEST_CASE("a frame that can't be read is left out, counted and told at the end") {
  const TemporaryDirectory folder;
  const std::string good = folder.write("a.pgm", pgm(2, 2, 1));
  const std::string bad = folder.write("b.pgm", "P5 2 2 255\nx");
  const std::string cut = folder.write("c.y4m", y4m(2, 5).substr(0, 50));
  FilesSource source({{good, bad, cut, good}, 0, false});
  const Played played = play(source);
  CHECK(played.greys == std::vector<int>{1, 5, 1});
  CHECK(played.numbers == std::vector<std::int64_t>{0, 2, 4});
  CHECK(source.dropped() == 2);
  CHECK_FALSE(source.complete());
}

TEST_CASE("a loop over files that have all become unreadable ends") {
  const TemporaryDirectory folder;
  const std::string path = folder.write("a.pgm", pgm(2, 2, 1));
  FilesSource source({{path}, 0, true});
  CHECK(play(source, 1).greys.size() == 1);
  folder.write("a.pgm", "damaged");
  CHECK(play(source).greys.empty());
  CHECK(source.state() == CameraState::kEnded);
  CHECK_FALSE(source.complete());
}

TEST_CASE("what can't be played at all is refused with its name") {
  const TemporaryDirectory folder;
  const auto error = [](const std::vector<std::string>& paths) {
    return error_of([&] { FilesSource({paths, 0, false}); });
  };
  CHECK(error({folder.file("none.png")}) == folder.file("none.png") + ": no such file or folder");
  CHECK(error({folder.file("")}).find("no images") != std::string::npos);
  CHECK(error({folder.write("a.png", "text")}).starts_with(folder.file("a.png")));
  CHECK(error({folder.write("a.y4m", "text")}).starts_with(folder.file("a.y4m")));
  CHECK(error({}) == "no files to play");
}

TEST_CASE("a frame rate is not exceeded") {
  const TemporaryDirectory folder;
  FilesSource source({{folder.write("a.y4m", y4m(5, 1))}, 200, false});
  const std::int64_t start_ns = monotonic_ns();
  CHECK(play(source).greys.size() == 5);
  CHECK(monotonic_ns() - start_ns >= 20'000'000 - 5'000'000);
}
