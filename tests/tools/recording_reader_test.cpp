#include "tools/recording_reader.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "tests/error_of.hpp"

using namespace roundel;

namespace {

using Json = nlohmann::ordered_json;

std::string frame_text(int number, int width, int height, char grey) {
  return Json{{"frame", number},         {"utime", 1000 * number}, {"session", 7},
              {"unrecorded", 0},         {"width", width},         {"height", height},
              {"markers", Json::array()}}
             .dump() +
         "\n" + std::string(static_cast<std::size_t>(width * height), grey);
}

struct Taken {
  std::vector<Json> headings;
  std::vector<std::int64_t> numbers;
  std::vector<std::string> pictures;
};

Taken take_apart(const std::string& stream, std::size_t piece) {
  Taken taken;
  RecordingReader reader([&](const Json& heading) { taken.headings.push_back(heading); },
                         [&](const RecordingReader::Frame& frame) {
                           taken.numbers.push_back(frame.number);
                           CHECK(frame.utime == 1000 * frame.number);
                           CHECK(Json::parse(frame.line)["frame"] == frame.number);
                           taken.pictures.emplace_back(
                               reinterpret_cast<const char*>(frame.picture.data),
                               static_cast<std::size_t>(frame.picture.width) *
                                   static_cast<std::size_t>(frame.picture.height));
                         });
  for (std::size_t at = 0; at < stream.size(); at += piece) reader.take(stream.substr(at, piece));
  return taken;
}

}  // namespace

TEST_CASE("a recording is taken apart wherever its pieces end") {
  // The second picture is full of line ends.
  const std::string stream = "{\"recording\":1}\n" + frame_text(3, 4, 2, 'a') +
                             frame_text(4, 4, 2, '\n') + frame_text(6, 3, 1, '{');
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    CAPTURE(piece);
    const Taken taken = take_apart(stream, piece);
    REQUIRE(taken.headings.size() == 1);
    CHECK(taken.headings[0]["recording"] == 1);
    CHECK(taken.numbers == std::vector<std::int64_t>{3, 4, 6});
    CHECK(taken.pictures ==
          std::vector<std::string>{std::string(8, 'a'), std::string(8, '\n'), std::string(3, '{')});
  }
}

TEST_CASE("what is no recording is refused") {
  CHECK(error_of([] { take_apart("nonsense\n", 100); }) ==
        "the recording has a line that is not JSON");
  CHECK(error_of([] { take_apart("{}\n{\"width\": 3}\n", 100); }) == "height is missing");
  CHECK(error_of([] { take_apart("{}\n{\"width\": 1e9}\n", 100); }) != "");
}
