#include "daemon/image_file.hpp"

#include <doctest/doctest.h>
#include <png.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <jpeglib.h>

#include "tests/temporary_directory.hpp"

namespace roundel {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A picture with slopes and an edge, so that shifted or swapped pixels are noticed.
GreyImage test_picture(int width, int height) {
  GreyImage image;
  image.resize(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      image.pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(u)] =
          static_cast<std::uint8_t>((u * 7 + v * 3 + (u > width / 2 ? 100 : 0)) % 256);
    }
  }
  return image;
}

std::string png_file(const TemporaryDirectory& directory, int width, int height, png_uint_32 format,
                     const Bytes& pixels) {
  std::string path = directory.file("picture.png");
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width);
  png.height = static_cast<png_uint_32>(height);
  png.format = format;
  REQUIRE(png_image_write_to_file(&png, path.c_str(), 0, pixels.data(), 0, nullptr) != 0);
  return path;
}

// With libpng's full interface, for what the simple one does not write.
std::string png_file(const TemporaryDirectory& directory, const GreyImage& image, int depth,
                     int interlace) {
  std::string path = directory.file("full.png");
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), depth, PNG_COLOR_TYPE_GRAY, interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  std::vector<Bytes> rows;
  rows.reserve(static_cast<std::size_t>(image.height));
  std::vector<png_bytep> row_pointers;
  row_pointers.reserve(rows.capacity());
  for (int v = 0; v < image.height; ++v) {
    Bytes row;
    for (int u = 0; u < image.width; ++u) {
      row.push_back(image.view().at(u, v));
      if (depth == 16) {
        row.push_back(image.view().at(u, v));  // v * 257: exact in 16 bits
      }
    }
    rows.push_back(row);
  }
  for (Bytes& row : rows) {
    row_pointers.push_back(row.data());
  }
  png_write_image(png, row_pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  return path;
}

Bytes jpeg_bytes(int width, int height, int components, const Bytes& pixels,
                 bool progressive = false) {
  jpeg_compress_struct info = {};
  jpeg_error_mgr errors = {};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &buffer, &size);
  info.image_width = static_cast<JDIMENSION>(width);
  info.image_height = static_cast<JDIMENSION>(height);
  info.input_components = components;
  info.in_color_space = components == 3 ? JCS_RGB : components == 4 ? JCS_CMYK : JCS_GRAYSCALE;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 98, TRUE);
  if (progressive) {
    jpeg_simple_progression(&info);
  }
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    JSAMPROW row =
        const_cast<JSAMPROW>(pixels.data() + std::size_t{info.next_scanline} * info.image_width *
                                                 static_cast<unsigned>(components));
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  Bytes bytes(buffer, buffer + size);
  std::free(buffer);
  return bytes;
}

std::string as_string(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

std::string reading_error(const std::string& path) {
  try {
    load_image(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a grey PNG comes back as it was saved") {
  const TemporaryDirectory directory;
  const GreyImage image = test_picture(37, 21);
  save_png(directory.file("a.png"), image.view());
  const GreyImage read = load_image(directory.file("a.png"));
  CHECK(read.width == 37);
  CHECK(read.height == 21);
  CHECK(read.pixels == image.pixels);
}

TEST_CASE("a strided view is saved as the picture it shows") {
  const TemporaryDirectory directory;
  const GreyImage packed = test_picture(20, 8);  // read as YUYV: 10 pixels of 2 bytes
  save_png(directory.file("a.png"), yuyv_view(packed.pixels.data(), 10, 8, 20));
  const GreyImage read = load_image(directory.file("a.png"));
  REQUIRE(read.width == 10);
  for (int v = 0; v < 8; ++v) {
    for (int u = 0; u < 10; ++u) {
      CHECK(read.view().at(u, v) == packed.view().at(2 * u, v));
    }
  }
}

TEST_CASE("interlaced and 16-bit PNG are read exactly, whatever their size") {
  const TemporaryDirectory directory;
  for (const int depth : {8, 16}) {
    for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
      for (int width = 1; width <= 18; ++width) {
        const GreyImage image = test_picture(width, 19 - width);
        CHECK(load_image(png_file(directory, image, depth, interlace)).pixels == image.pixels);
      }
    }
  }
}

TEST_CASE("a colour PNG becomes luma by BT.601, over white where it is transparent") {
  const TemporaryDirectory directory;
  const Bytes pixels = {255, 0,  0,  255, 0, 255, 0, 255, 0,  0,   255, 255,
                        80,  80, 80, 255, 0, 0,   0, 0,   10, 200, 30,  255};
  const GreyImage read = load_image(png_file(directory, 6, 1, PNG_FORMAT_RGBA, pixels));
  const Bytes expected = {76, 150, 29, 80, 255, 124};
  REQUIRE(read.pixels.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    // The simple interface writes sRGB; half-transparent pixels apart, values are kept.
    CHECK(std::abs(int{read.pixels[i]} - int{expected[i]}) <= 1);
  }
}

TEST_CASE("a JPEG is read as its luma") {
  const TemporaryDirectory directory;
  GreyImage image;
  image.resize(64, 48);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<std::uint8_t>(40 + i % 64 * 2);
  }
  Bytes red;
  for (int i = 0; i < 64 * 48; ++i) {
    red.insert(red.end(), {200, 30, 30});
  }
  for (const bool progressive : {false, true}) {
    directory.write("g.jpg", as_string(jpeg_bytes(64, 48, 1, image.pixels, progressive)));
    const GreyImage grey = load_image(directory.file("g.jpg"));
    REQUIRE(grey.width == 64);
    REQUIRE(grey.height == 48);
    for (std::size_t i = 0; i < grey.pixels.size(); ++i) {
      REQUIRE(std::abs(int{grey.pixels[i]} - int{image.pixels[i]}) <= 3);
    }
    directory.write("r.jpg", as_string(jpeg_bytes(64, 48, 3, red, progressive)));
    CHECK(std::abs(int{load_image(directory.file("r.jpg")).pixels[100]} - 81) <= 1);
  }
}

TEST_CASE("PGM is read in text and binary, in 8 and 16 bits, with comments") {
  const TemporaryDirectory directory;
  const Bytes expected = {0, 128, 255, 10, 20, 30};
  CHECK(load_image(directory.write("a", "P2\n# made by hand\n3 2 # size\n255\n0 128 255\n10 20 30"))
            .pixels == expected);
  CHECK(load_image(directory.write("b", std::string("P5 3 2 255\n\x00\x80\xff\x0a\x14\x1e", 17)))
            .pixels == expected);
  CHECK(load_image(
            directory.write(
                "c", std::string("P5 3 2 65535\n\0\0\x80\x80\xff\xff\x0a\x0a\x14\x14\x1e\x1e", 25)))
            .pixels == expected);
  CHECK(load_image(directory.write("d", "P2 3 1 15 0 8 15")).pixels == Bytes{0, 136, 255});
}

TEST_CASE("a file that is no image is refused with its name and the reason") {
  const TemporaryDirectory directory;
  CHECK(contains(reading_error(directory.file("none.png")),
                 "none.png can't be opened: No such file"));
  CHECK(contains(reading_error(directory.write("empty.png", "")), "empty.png is empty"));
  CHECK(contains(reading_error(directory.write("text.png", "hello, world")),
                 "text.png is not an image that can be read (PNG, JPEG or PGM)"));
  CHECK(contains(reading_error(directory.file("")), "can't be read: Is a directory"));
  CHECK(contains(reading_error("/dev/zero"), "is not an image"));
  CHECK(contains(
      reading_error(directory.write("cmyk.jpg", as_string(jpeg_bytes(4, 4, 4, Bytes(64, 100))))),
      "cmyk.jpg is truncated or damaged (JPEG: Unsupported color conversion request)"));
}

TEST_CASE("an image with impossible sides is refused before memory is taken for it") {
  const TemporaryDirectory directory;
  CHECK(contains(reading_error(directory.write("a.pgm", "P5 16385 1 255\n")),
                 "is too large: 16385x1"));
  CHECK(contains(reading_error(directory.write("a.pgm", "P5 0 7 255\n")), "has no pixels (0x7)"));
  CHECK(contains(reading_error(directory.write("a.pgm", "P5 99999999999999 1 255\n")),
                 "impossible width"));
  CHECK(contains(reading_error(directory.write("a.pgm", "P5 16000 16000 255\n12345")),
                 "is truncated: 5 bytes of pixels for 16000x16000"));
  CHECK(contains(reading_error(directory.write("a.pgm", "P2 16000 16000 255\n12345")),
                 "is truncated"));
  CHECK(contains(reading_error(directory.write("a.pgm", "P2 1 1 0\n0")), "maximum value of 0"));
  CHECK(contains(reading_error(directory.write("a.pgm", "P2 1 1 100\n101")),
                 "101 is above its maximum"));
  GreyImage wide;
  wide.resize(16385, 1);
  save_png(directory.file("wide.png"), wide.view());
  CHECK(contains(reading_error(directory.file("wide.png")),
                 "is too large: 16385x1, at most 16384x16384"));
}

TEST_CASE("an image cut short at any byte is an error and never a picture with a grey bottom") {
  const TemporaryDirectory directory;
  const GreyImage image = test_picture(24, 16);
  save_png(directory.file("a.png"), image.view());
  const std::vector<std::string> whole = {
      read_file(directory.file("a.png")),
      read_file(png_file(directory, image, 8, PNG_INTERLACE_ADAM7)),
      as_string(jpeg_bytes(24, 16, 1, image.pixels)),
      as_string(jpeg_bytes(24, 16, 1, image.pixels, true)),
      "P5 24 16 255\n" + as_string(image.pixels),
      "P2 3 2 255 1 2 3 4 5 ",  // a cut number would still be a number: the last one is missing
  };
  for (const std::string& contents : whole) {
    for (std::size_t length = 0; length < contents.size(); ++length) {
      CAPTURE(length);
      REQUIRE(reading_error(directory.write("cut", contents.substr(0, length))) != "");
    }
  }
}

TEST_CASE("damaged images end in an error or in a picture, never in a crash") {
  const TemporaryDirectory directory;
  const GreyImage image = test_picture(24, 16);
  save_png(directory.file("a.png"), image.view());
  const std::vector<std::string> whole = {
      read_file(directory.file("a.png")), as_string(jpeg_bytes(24, 16, 1, image.pixels)),
      as_string(jpeg_bytes(24, 16, 1, image.pixels, true)), "P2 3 2 255 1 2 3 4 5 6"};
  std::mt19937 random(5);
  ImageLoader loader;
  GreyImage read;
  int errors = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string contents = whole[static_cast<std::size_t>(i) % whole.size()];
    for (int hits = 1 + i % 5; hits > 0; --hits) {
      // Spare the dimensions: a huge black picture is no crash, but slow.
      contents[24 % contents.size() + random() % (contents.size() - 24 % contents.size())] =
          static_cast<char>(random());
    }
    try {
      loader.load(directory.write("damaged", contents), read);
      CHECK(read.pixels.size() == static_cast<std::size_t>(read.width * read.height));
    } catch (const std::runtime_error& error) {
      ++errors;
      CHECK(contains(error.what(), "damaged "));
    }
  }
  CHECK(errors > 500);
}

TEST_CASE("loading images of one size again and again keeps the image's memory") {
  const TemporaryDirectory directory;
  save_png(directory.file("a.png"), test_picture(64, 48).view());
  save_png(directory.file("b.png"), test_picture(32, 48).view());
  ImageLoader loader;
  GreyImage image;
  loader.load(directory.file("a.png"), image);
  const std::uint8_t* before = image.pixels.data();
  loader.load(directory.file("b.png"), image);
  loader.load(directory.file("a.png"), image);
  CHECK(image.pixels.data() == before);
  CHECK(image.pixels == test_picture(64, 48).pixels);
}

TEST_CASE("a PNG that can't be written says so") {
  CHECK_THROWS_WITH_AS(save_png("/nowhere/a.png", test_picture(2, 2).view()),
                       "/nowhere/a.png can't be written: No such file or directory",
                       std::runtime_error);
}

}  // namespace roundel
