#include "daemon/capture/luma_reader.hpp"

#include <doctest/doctest.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "daemon/capture/video_device.hpp"
#include "tests/jpeg_bytes.hpp"

using namespace roundel;

namespace {

const PixelFormat& format(std::uint32_t fourcc) {
  const PixelFormat* const found = find_pixel_format(fourcc);
  REQUIRE(found != nullptr);
  return *found;
}

std::vector<std::uint8_t> even_jpeg(int width, int height, std::uint8_t luma) {
  GreyImage picture;
  picture.resize(width, height);
  std::fill(picture.pixels.begin(), picture.pixels.end(), luma);
  return jpeg_bytes(picture, 100);
}

// What a noisy camera sends.
GreyImage noise(int width, int height) {
  std::mt19937 random(3);
  GreyImage picture;
  picture.resize(width, height);
  for (std::uint8_t& pixel : picture.pixels) pixel = static_cast<std::uint8_t>(random());
  return picture;
}

std::vector<std::uint8_t> bytes(std::size_t count) {
  std::vector<std::uint8_t> all(count);
  std::iota(all.begin(), all.end(), std::uint8_t{0});
  return all;
}

}  // namespace

TEST_CASE("grey and luma planes are read where they lie, chroma or not") {
  const std::vector<std::uint8_t> frame = bytes(10 * 4);
  for (const std::uint32_t fourcc : {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_NV12, V4L2_PIX_FMT_NV21,
                                     V4L2_PIX_FMT_YUV420, V4L2_PIX_FMT_YVU420}) {
    LumaReader reader({format(fourcc), 8, 4, 10}, {});
    const auto view = reader.read(frame);
    REQUIRE(view.has_value());
    CHECK(view->data == frame.data());
    CHECK(view->at(3, 2) == 23);
    CHECK(reader.in_place());
  }
}

TEST_CASE("packed formats are read by stride") {
  const std::vector<std::uint8_t> frame = bytes(20 * 4);
  const auto sample = [&](std::uint32_t fourcc) {
    return LumaReader({format(fourcc), 8, 4, 20}, {}).read(frame)->at(3, 2);
  };
  CHECK(sample(V4L2_PIX_FMT_YUYV) == 46);
  CHECK(sample(V4L2_PIX_FMT_YVYU) == 46);
  CHECK(sample(V4L2_PIX_FMT_UYVY) == 47);
  CHECK(sample(V4L2_PIX_FMT_VYUY) == 47);
  CHECK(sample(V4L2_PIX_FMT_Y16) == 47);  // the high byte
  CHECK(sample(V4L2_PIX_FMT_Y16_BE) == 46);
}

TEST_CASE("grey of 10, 12 and 14 bits is reduced to its high eight") {
  struct Case {
    std::uint32_t fourcc;
    int bits;
  };
  for (const Case& c :
       {Case{V4L2_PIX_FMT_Y10, 10}, Case{V4L2_PIX_FMT_Y12, 12}, Case{V4L2_PIX_FMT_Y14, 14}}) {
    std::vector<std::uint8_t> frame;
    for (int i = 0; i < 32; ++i) {
      const int word = ((i * 8) << (c.bits - 8)) | ((1 << (c.bits - 8)) - 1);
      frame.push_back(static_cast<std::uint8_t>(word & 0xff));
      frame.push_back(static_cast<std::uint8_t>(word >> 8));
    }
    LumaReader reader({format(c.fourcc), 8, 4, 16}, {});
    CHECK_FALSE(reader.in_place());
    const auto view = reader.read(frame);
    REQUIRE(view.has_value());
    for (int v = 0; v < 4; ++v) {
      for (int u = 0; u < 8; ++u) CHECK(view->at(u, v) == (8 * v + u) * 8);
    }
  }
}

TEST_CASE("packed ten bits: the fifth byte of every group is left out") {
  const std::vector<std::uint8_t> frame = bytes(10 * 2);
  LumaReader reader({format(V4L2_PIX_FMT_Y10P), 8, 2, 10}, {});
  const auto view = reader.read(frame);
  REQUIRE(view.has_value());
  for (int u = 0; u < 8; ++u) CHECK(view->at(u, 1) == 10 + u / 4 * 5 + u % 4);
}

TEST_CASE("raw Bayer is read at its green sites") {
  // Every pixel tells where it is.
  constexpr int kWidth = 8, kHeight = 4;
  struct Case {
    std::uint32_t bytes8, words10, packed10, packed12, bytes16;
    int green;  // its column in the upper row of a cell
  };
  const std::vector<Case> cases = {
      {V4L2_PIX_FMT_SBGGR8, V4L2_PIX_FMT_SBGGR10, V4L2_PIX_FMT_SBGGR10P, V4L2_PIX_FMT_SBGGR12P,
       V4L2_PIX_FMT_SBGGR16, 1},
      {V4L2_PIX_FMT_SGBRG8, V4L2_PIX_FMT_SGBRG10, V4L2_PIX_FMT_SGBRG10P, V4L2_PIX_FMT_SGBRG12P,
       V4L2_PIX_FMT_SGBRG16, 0},
      {V4L2_PIX_FMT_SGRBG8, V4L2_PIX_FMT_SGRBG10, V4L2_PIX_FMT_SGRBG10P, V4L2_PIX_FMT_SGRBG12P,
       V4L2_PIX_FMT_SGRBG16, 0},
      {V4L2_PIX_FMT_SRGGB8, V4L2_PIX_FMT_SRGGB10, V4L2_PIX_FMT_SRGGB10P, V4L2_PIX_FMT_SRGGB12P,
       V4L2_PIX_FMT_SRGGB16, 1}};
  std::vector<std::uint8_t> plain, words10, words16, packed10, packed12;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const int value = 16 * v + u;
      plain.push_back(static_cast<std::uint8_t>(value));
      words10.push_back(static_cast<std::uint8_t>((value << 2) & 0xff));
      words10.push_back(static_cast<std::uint8_t>(value >> 6));
      words16.push_back(0xff);
      words16.push_back(static_cast<std::uint8_t>(value));
      packed10.push_back(static_cast<std::uint8_t>(value));
      packed12.push_back(static_cast<std::uint8_t>(value));
      if (u % 4 == 3) packed10.push_back(0xff);
      if (u % 2 == 1) packed12.push_back(0xff);
    }
  }
  for (const Case& c : cases) {
    const auto check = [&](std::uint32_t fourcc, const std::vector<std::uint8_t>& frame,
                           int stride) {
      CAPTURE(fourcc_name(fourcc));
      LumaReader reader({format(fourcc), kWidth, kHeight, stride}, {});
      CHECK(reader.width() == kWidth / 2);
      CHECK(reader.height() == kHeight / 2);
      const auto view = reader.read(frame);
      REQUIRE(view.has_value());
      for (int v = 0; v < kHeight / 2; ++v) {
        for (int u = 0; u < kWidth / 2; ++u) {
          CHECK(view->at(u, v) == 16 * (2 * v) + 2 * u + c.green);
        }
      }
    };
    check(c.bytes8, plain, kWidth);
    check(c.words10, words10, 2 * kWidth);
    check(c.bytes16, words16, 2 * kWidth);
    check(c.packed10, packed10, kWidth * 5 / 4);
    check(c.packed12, packed12, kWidth * 3 / 2);
  }
}

TEST_CASE("no view reaches outside of the bytes that it was made of") {
  for (const PixelFormat& one : pixel_formats()) {
    if (one.reading == Reading::kJpeg) continue;
    CAPTURE(fourcc_name(one.fourcc));
    for (const int width : {2, 3, 7, 8}) {
      const int stride = (width * one.bits_per_pixel + 7) / 8 + 3;
      LumaReader reader({one, width, 5, stride}, {});
      const auto whole = static_cast<std::size_t>(4 * stride + stride - 3);
      const std::vector<std::uint8_t> frame = bytes(whole);
      const auto view = reader.read(frame);
      REQUIRE(view.has_value());
      CHECK_FALSE(reader.read(std::span(frame).first(whole - 1)).has_value());
      CHECK_FALSE(reader.read({}).has_value());
      if (!reader.in_place()) continue;
      const std::uint8_t* const last =
          view->row(view->height - 1) + (view->width - 1) * view->pixel_stride;
      CHECK(view->data >= frame.data());
      CHECK(last < frame.data() + whole);
    }
  }
}

TEST_CASE("a crop shows its part, on whole Bayer cells") {
  const std::vector<std::uint8_t> frame = bytes(16 * 8);
  CHECK(LumaReader({format(V4L2_PIX_FMT_GREY), 16, 8, 16}, {3, 2, 4, 4}).read(frame)->at(1, 1) ==
        16 * 3 + 4);
  CHECK(LumaReader({format(V4L2_PIX_FMT_SGRBG8), 16, 8, 16}, {3, 3, 4, 4}).read(frame)->at(1, 1) ==
        16 * 4 + 4);
  for (const Crop& crop : {Crop{-1, 0, 4, 4}, Crop{0, -1, 4, 4}, Crop{13, 0, 4, 4},
                           Crop{0, 5, 4, 4}, Crop{0, 0, -4, 4}, Crop{2'000'000'000, 0, 4, 4}}) {
    CHECK_THROWS_AS(LumaReader({format(V4L2_PIX_FMT_GREY), 16, 8, 16}, crop), CameraError);
  }
}

TEST_CASE("layouts that can't be are refused") {
  for (const FrameLayout& layout : {FrameLayout{format(V4L2_PIX_FMT_GREY), 0, 8, 16},
                                    FrameLayout{format(V4L2_PIX_FMT_GREY), 16, -8, 16},
                                    FrameLayout{format(V4L2_PIX_FMT_GREY), 1 << 30, 1 << 30, 16},
                                    FrameLayout{format(V4L2_PIX_FMT_YUYV), 16, 8, 31},
                                    FrameLayout{format(V4L2_PIX_FMT_GREY), 16, 8, -16}}) {
    CHECK_THROWS_AS(LumaReader(layout, {}), CameraError);
  }
}

TEST_CASE("the luma of a JPEG is decoded into the same memory again and again") {
  LumaReader reader({format(V4L2_PIX_FMT_MJPEG), 64, 48, 0}, {});
  const std::vector<std::uint8_t> jpeg = even_jpeg(64, 48, 200);
  const auto first = reader.read(jpeg);
  REQUIRE(first.has_value());
  CHECK(first->width == 64);
  CHECK(first->at(10, 10) == 200);
  const std::uint8_t* const memory = first->data;
  const auto second = reader.read(even_jpeg(64, 48, 100));
  REQUIRE(second.has_value());
  CHECK(second->data == memory);
  CHECK(second->at(10, 10) == 100);
}

TEST_CASE("damaged JPEGs are refused, and the next whole one is read") {
  LumaReader reader({format(V4L2_PIX_FMT_MJPEG), 64, 48, 0}, {});
  const std::vector<std::uint8_t> jpeg = even_jpeg(64, 48, 200);
  CHECK_FALSE(reader.read({}).has_value());
  CHECK_FALSE(reader.read(even_jpeg(32, 48, 200)).has_value());
  for (std::size_t length = 0; length < jpeg.size() - 2; length += 37) {
    CHECK_FALSE(reader.read(std::span(jpeg).first(length)).has_value());
  }
  CHECK_FALSE(reader.read(bytes(5000)).has_value());
  CHECK(reader.read(jpeg).has_value());
}

TEST_CASE("whatever is changed in a JPEG, it is refused or a picture of the camera's size") {
  LumaReader reader({format(V4L2_PIX_FMT_MJPEG), 64, 48, 0}, {});
  const std::vector<std::uint8_t> whole = jpeg_bytes(noise(64, 48), 90);
  const auto frame_header =
      std::search(whole.begin(), whole.end(), "\xff\xc0", "\xff\xc0" + 2,
                  [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); }) -
      whole.begin();
  std::mt19937 random(8);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint8_t> changed = whole;
    for (int hits = 1 + i % 4; hits > 0; --hits) {
      // Every second time in the headers: sizes, planes, tables.
      const std::size_t range =
          i % 2 == 0 ? changed.size() : static_cast<std::size_t>(frame_header) + 40;
      changed[random() % range] = static_cast<std::uint8_t>(random());
    }
    if (i % 5 == 0) changed.resize(random() % changed.size());
    const auto view = reader.read(changed);
    if (view) {
      CHECK(view->width == 64);
      CHECK(view->height == 48);
    } else {
      ++refused;
    }
  }
  CHECK(refused > 1000);
  // As large as the format allows.
  std::vector<std::uint8_t> huge = whole;
  for (std::ptrdiff_t i = 5; i < 9; ++i) huge[static_cast<std::size_t>(frame_header + i)] = 0xff;
  CHECK_FALSE(reader.read(huge).has_value());
  CHECK(reader.read(whole).has_value());
}

// Every scan costs a pass over the picture, and a small file may have very many.
TEST_CASE("JPEGs of several scans are no camera's, and one of very many is refused by all") {
  LumaReader reader({format(V4L2_PIX_FMT_MJPEG), 64, 48, 0}, {});
  const GreyImage picture = noise(64, 48);
  for (const JpegScans scans : {JpegScans::kOneForEachPlane, JpegScans::kProgressive}) {
    const std::vector<std::uint8_t> jpeg = jpeg_bytes(picture, 90, scans);
    CHECK_FALSE(reader.read(jpeg).has_value());
    JpegDecoder decoder;
    GreyImage read;
    read.resize(64, 48);
    REQUIRE(decoder.read_header(jpeg));
    CHECK(decoder.read_luma(read.pixels.data()));
  }
  // The last plane again and again.
  std::vector<std::uint8_t> many = jpeg_bytes(picture, 90, JpegScans::kOneForEachPlane);
  std::size_t scan = many.size() - 2;
  while (many[scan] != 0xff || many[scan + 1] != 0xda) --scan;
  const std::vector<std::uint8_t> last(many.begin() + static_cast<std::ptrdiff_t>(scan),
                                       many.end() - 2);
  for (int i = 0; i < 200; ++i) many.insert(many.end() - 2, last.begin(), last.end());
  JpegDecoder decoder;
  GreyImage read;
  read.resize(64, 48);
  REQUIRE(decoder.read_header(many));
  CHECK_FALSE(decoder.read_luma(read.pixels.data()));
  CHECK(std::string(decoder.message()).find("scans") != std::string::npos);
  CHECK(reader.read(jpeg_bytes(picture, 90)).has_value());
}

TEST_CASE("a JPEG without Huffman tables, as cameras send them, is read with the standard ones") {
  std::vector<std::uint8_t> jpeg = even_jpeg(64, 48, 77);
  // Takes out the DHT segments.
  for (std::size_t at = 2; at + 4 < jpeg.size() && jpeg[at + 1] != 0xda;) {
    const std::size_t length = 2U + (jpeg[at + 2] << 8 | jpeg[at + 3]);
    if (jpeg[at + 1] == 0xc4) {
      jpeg.erase(jpeg.begin() + static_cast<std::ptrdiff_t>(at),
                 jpeg.begin() + static_cast<std::ptrdiff_t>(at + length));
    } else {
      at += length;
    }
  }
  LumaReader reader({format(V4L2_PIX_FMT_MJPEG), 64, 48, 0}, {});
  const auto view = reader.read(jpeg);
  REQUIRE(view.has_value());
  CHECK(view->at(20, 20) == 77);
}

TEST_CASE("a four-letter code is named as v4l2-ctl names it, and read back") {
  for (const PixelFormat& one : pixel_formats()) {
    CHECK(parse_fourcc(fourcc_name(one.fourcc)) == one.fourcc);
  }
  CHECK(fourcc_name(V4L2_PIX_FMT_Y16_BE) == "Y16-BE");
  CHECK(fourcc_name(V4L2_PIX_FMT_Y10) == "Y10");
  CHECK_FALSE(parse_fourcc("").has_value());
  CHECK_FALSE(parse_fourcc("YUYVX").has_value());
  CHECK_FALSE(parse_fourcc("Y\n").has_value());
}
