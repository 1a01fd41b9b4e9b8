#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace roundel {

// How the luma of a V4L2 pixel format is read.
enum class Reading : std::uint8_t {
  kInPlace,   // bytes at regular distances: read where the driver put them
  kWords,     // low bits of 16-bit little-endian words: shifted into a buffer of our own
  kPacked10,  // MIPI: four pixels in five bytes, the high eight bits first: gathered likewise
  kJpeg,      // decoded, luma alone
};

// Where luma lies in a row of pixels. A raw Bayer format is read at one of the two green sites of
// every 2x2 cell (the one in the cell's upper row), and so at half its width and height.
struct PixelFormat {
  std::uint32_t fourcc = 0;
  Reading reading = Reading::kInPlace;
  int bits_per_pixel = 8;  // of a row of the first plane; 0 for JPEG
  int cell = 1;            // pixels, each way, that make one of ours: 2 for Bayer
  int offset = 0;          // bytes (kWords, kPacked10: pixels) from a row's start to the first luma
  int pixel_stride = 1;    // bytes (kWords, kPacked10: pixels) from one luma sample to the next
  int shift = 0;           // kWords: down to eight bits
};

// Those that are understood, the ones that cost least first.
std::span<const PixelFormat> pixel_formats();
const PixelFormat* find_pixel_format(std::uint32_t fourcc);
// Its place in pixel_formats().
int cost_rank(const PixelFormat& format);

// As v4l2-ctl writes it, without trailing spaces: GREY, Y16, Y16-BE for the big-endian flag.
std::string fourcc_name(std::uint32_t fourcc);
// One to four characters, and -BE; nothing for anything else.
std::optional<std::uint32_t> parse_fourcc(std::string_view name);

// "read in place", and so on.
std::string_view how_it_is_read(const PixelFormat& format);

}  // namespace roundel
