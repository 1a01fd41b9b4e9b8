#include "daemon/y4m.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/temporary_directory.hpp"

namespace roundel {
namespace {

GreyImage random_picture(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  GreyImage image;
  image.resize(width, height);
  for (std::uint8_t& pixel : image.pixels) {
    pixel = static_cast<std::uint8_t>(random());
  }
  return image;
}

std::string luma(const GreyImage& image) {
  return {image.pixels.begin(), image.pixels.end()};
}

std::vector<GreyImage> read_all(const std::string& path) {
  Y4mReader reader(path);
  std::vector<GreyImage> frames;
  for (GreyImage frame; reader.next(frame);) {
    frames.push_back(frame);
  }
  return frames;
}

std::string video_error(const std::string& path) {
  try {
    read_all(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("frames written as y4m come back unchanged") {
  const TemporaryDirectory directory;
  const std::string path = directory.file("a.y4m");
  Y4mWriter writer(path, 31, 17, 25);
  for (unsigned i = 0; i < 5; ++i) {
    writer.write(random_picture(31, 17, i).view());
  }
  writer.close();
  Y4mReader reader(path);
  CHECK(reader.format().width == 31);
  CHECK(reader.format().height == 17);
  CHECK(reader.format().frames_per_second() == 25.0);
  GreyImage frame;
  for (unsigned i = 0; i < 5; ++i) {
    REQUIRE(reader.next(frame));
    CHECK(frame.pixels == random_picture(31, 17, i).pixels);
  }
  CHECK_FALSE(reader.next(frame));
  CHECK(reader.frames_read() == 5);
}

TEST_CASE("number and time of a frame come back, where they were written") {
  const TemporaryDirectory directory;
  const std::string path = directory.file("a.y4m");
  Y4mWriter writer(path, 4, 2, 30);
  writer.write(random_picture(4, 2, 1).view(), Y4mStamp{41, 1'700'000'000'123'456});
  writer.write(random_picture(4, 2, 2).view());
  writer.close();
  Y4mReader reader(path);
  GreyImage frame;
  REQUIRE(reader.next(frame));
  REQUIRE(reader.stamp().has_value());
  CHECK(reader.stamp()->number == 41);
  CHECK(reader.stamp()->utime == 1'700'000'000'123'456);
  REQUIRE(reader.next(frame));
  CHECK_FALSE(reader.stamp().has_value());
}

TEST_CASE("a damaged stamp is none, and its frame is read") {
  const TemporaryDirectory directory;
  for (const char* stamp : {" XN=1", " XN= XT=5", " XN=-1 XT=5", " XN=1 XT=99999999999999999999",
                            " XN=one XT=5", " Xother"}) {
    CAPTURE(stamp);
    Y4mReader reader(directory.write(
        "a.y4m", "YUV4MPEG2 W4 H2 Cmono\nFRAME" + std::string(stamp) + "\n" + "12345678"));
    GreyImage frame;
    REQUIRE(reader.next(frame));
    CHECK(frame.pixels[7] == '8');
    CHECK_FALSE(reader.stamp().has_value());
  }
}

TEST_CASE("pixels that lie apart are written like any others") {
  const TemporaryDirectory directory;
  const std::string path = directory.file("a.y4m");
  const std::string yuyv = "a.b.c.d.e.f.g.h.";
  Y4mWriter writer(path, 4, 2, 30);
  writer.write(yuyv_view(reinterpret_cast<const std::uint8_t*>(yuyv.data()), 4, 2, 8));
  writer.close();
  CHECK(luma(read_all(path).at(0)) == "abcdefgh");
}

TEST_CASE("the luma is taken and the chroma skipped in every colour space of 8 bits") {
  const TemporaryDirectory directory;
  const GreyImage first = random_picture(5, 3, 1);  // odd sides: chroma planes are rounded up
  const GreyImage second = random_picture(5, 3, 2);
  const std::vector<std::pair<std::string, std::size_t>> spaces = {
      {"", 12},      {" C420", 12}, {" C420jpeg", 12}, {" C420mpeg2", 12}, {" C420paldv", 12},
      {" C411", 12}, {" C422", 18}, {" C444", 30},     {" C444alpha", 45}, {" Cmono", 0}};
  for (const auto& entry : spaces) {
    const std::string& space = entry.first;
    CAPTURE(space);
    const std::string chroma(entry.second, '\x55');
    std::string video = "YUV4MPEG2 W5 H3 F30000:1001 It A0:0";
    video.append(space).append(" XCOMMENT\n");
    video.append("FRAME\n").append(luma(first)).append(chroma);
    video.append("FRAME Ippp XSOME\n").append(luma(second)).append(chroma);
    const auto frames = read_all(directory.write("a.y4m", video));
    REQUIRE(frames.size() == 2);
    CHECK(frames[0].pixels == first.pixels);
    CHECK(frames[1].pixels == second.pixels);
  }
}

TEST_CASE("a wrong y4m header is refused with the reason") {
  const TemporaryDirectory directory;
  const auto error = [&](const std::string& contents) {
    return video_error(directory.write("a.y4m", contents));
  };
  CHECK(
      contains(video_error(directory.file("none.y4m")), "none.y4m can't be opened: No such file"));
  CHECK(contains(error(""), "a.y4m is empty"));
  CHECK(contains(error("\x89PNG\r\n..."), "is not y4m video: it does not start with YUV4MPEG2"));
  CHECK(contains(error("YUV4MPEG21 W5 H3\n"), "does not start with YUV4MPEG2"));
  CHECK(contains(error("YUV4MPEG2 W5 H3 C420"), "is not y4m video: its first line has no end"));
  CHECK(contains(error("YUV4MPEG2 " + std::string(10000, 'X') + "\n"), "first line has no end"));
  CHECK(contains(error("YUV4MPEG2 W5 F30:1\n"), "has no width (W) or no height (H)"));
  CHECK(contains(error("YUV4MPEG2 W5 H-3\n"), "has \"H-3\" in its header, not a size"));
  CHECK(contains(error("YUV4MPEG2 Wfive H3\n"), "has \"Wfive\" in its header"));
  CHECK(contains(error("YUV4MPEG2 W999999 H3\n"), "is too large: 999999x3"));
  CHECK(contains(error("YUV4MPEG2 W5 H3 F30\n"), "has the frame rate \"30\""));
  CHECK(contains(error("YUV4MPEG2 W5 H3 C420p10\n"), "has the colour space C420p10"));
  CHECK(contains(error("YUV4MPEG2 W5 H3 Cmono16\n"), "has the colour space Cmono16"));
}

TEST_CASE("y4m cut short at any byte names the frame that is missing") {
  const TemporaryDirectory directory;
  const GreyImage image = random_picture(5, 3, 1);
  const std::string header = "YUV4MPEG2 W5 H3 F30:1 C420\n";
  const std::string frame = "FRAME\n" + luma(image) + std::string(12, 'c');
  const std::string whole = header + frame + frame;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    CAPTURE(length);
    const std::string error = video_error(directory.write("a.y4m", whole.substr(0, length)));
    if (length < header.size()) {
      CHECK(error != "");
    } else if (length == header.size() || length == header.size() + frame.size()) {
      CHECK(error == "");  // between frames: a shorter video
    } else if (length < header.size() + frame.size()) {
      CHECK(contains(error, "a.y4m, frame 0, is truncated"));
    } else {
      CHECK(contains(error, "a.y4m, frame 1, is truncated"));
    }
  }
  CHECK(contains(video_error(directory.write("a.y4m", header + frame + "GARBAGE" + frame)),
                 "a.y4m, frame 1, does not start with FRAME"));
}

TEST_CASE("a frame of another size is not written into a video") {
  const TemporaryDirectory directory;
  Y4mWriter writer(directory.file("a.y4m"), 8, 8, 30);
  CHECK_THROWS_AS(writer.write(random_picture(8, 9, 1).view()), std::runtime_error);
}

TEST_CASE("a full disk is told when writing y4m") {
  CHECK_THROWS_WITH_AS(Y4mWriter("/dev/full", 8, 8, 30),
                       "/dev/full can't be written: No space left on device", std::runtime_error);
}

}  // namespace roundel
