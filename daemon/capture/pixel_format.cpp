#include "daemon/capture/pixel_format.hpp"

#include <linux/videodev2.h>

#include <array>

namespace roundel {
namespace {

constexpr PixelFormat plane(std::uint32_t fourcc) {
  return {fourcc, Reading::kInPlace, 8, 1, 0, 1, 0};
}
constexpr PixelFormat packed(std::uint32_t fourcc, int offset) {
  return {fourcc, Reading::kInPlace, 16, 1, offset, 2, 0};
}
constexpr PixelFormat words(std::uint32_t fourcc, int bits) {
  return {fourcc, Reading::kWords, 16, 1, 0, 1, bits - 8};
}
// green: its column in the upper row of a cell.
constexpr PixelFormat bayer8(std::uint32_t fourcc, int green) {
  return {fourcc, Reading::kInPlace, 8, 2, green, 2, 0};
}
constexpr PixelFormat bayer16(std::uint32_t fourcc, int green) {
  return {fourcc, Reading::kInPlace, 16, 2, 2 * green + 1, 4, 0};
}
// Two pixels in three bytes, their high eight bits first.
constexpr PixelFormat bayer12_packed(std::uint32_t fourcc, int green) {
  return {fourcc, Reading::kInPlace, 12, 2, green, 3, 0};
}
constexpr PixelFormat bayer_words(std::uint32_t fourcc, int bits, int green) {
  return {fourcc, Reading::kWords, 16, 2, green, 2, bits - 8};
}
constexpr PixelFormat bayer10_packed(std::uint32_t fourcc, int green) {
  return {fourcc, Reading::kPacked10, 10, 2, green, 2, 0};
}

// The first byte of 16 little-endian bits is the lower one.
constexpr int kLow = 0, kHigh = 1;

constexpr std::array kFormats = {
    plane(V4L2_PIX_FMT_GREY),
    // Luma planes; chroma is left alone.
    plane(V4L2_PIX_FMT_NV12),
    plane(V4L2_PIX_FMT_NV21),
    plane(V4L2_PIX_FMT_YUV420),
    plane(V4L2_PIX_FMT_YVU420),
    plane(V4L2_PIX_FMT_NV16),
    plane(V4L2_PIX_FMT_NV61),
    plane(V4L2_PIX_FMT_NV24),
    plane(V4L2_PIX_FMT_NV42),
    plane(V4L2_PIX_FMT_YUV422P),
    plane(V4L2_PIX_FMT_YUV411P),
    plane(V4L2_PIX_FMT_YUV410),
    plane(V4L2_PIX_FMT_YVU410),
    plane(V4L2_PIX_FMT_NV12M),
    plane(V4L2_PIX_FMT_NV21M),
    plane(V4L2_PIX_FMT_NV16M),
    plane(V4L2_PIX_FMT_NV61M),
    plane(V4L2_PIX_FMT_YUV420M),
    plane(V4L2_PIX_FMT_YVU420M),
    plane(V4L2_PIX_FMT_YUV422M),
    plane(V4L2_PIX_FMT_YVU422M),
    plane(V4L2_PIX_FMT_YUV444M),
    plane(V4L2_PIX_FMT_YVU444M),
    // Every second byte.
    packed(V4L2_PIX_FMT_YUYV, 0),
    packed(V4L2_PIX_FMT_YVYU, 0),
    packed(V4L2_PIX_FMT_UYVY, 1),
    packed(V4L2_PIX_FMT_VYUY, 1),
    packed(V4L2_PIX_FMT_Y16, kHigh),
    packed(V4L2_PIX_FMT_Y16_BE, kLow),
    packed(V4L2_PIX_FMT_P010, kHigh),
    // A pass over the frame.
    words(V4L2_PIX_FMT_Y10, 10),
    words(V4L2_PIX_FMT_Y12, 12),
    words(V4L2_PIX_FMT_Y14, 14),
    PixelFormat{V4L2_PIX_FMT_Y10P, Reading::kPacked10, 10, 1, 0, 1, 0},
    // Half the resolution.
    bayer8(V4L2_PIX_FMT_SBGGR8, 1),
    bayer8(V4L2_PIX_FMT_SGBRG8, 0),
    bayer8(V4L2_PIX_FMT_SGRBG8, 0),
    bayer8(V4L2_PIX_FMT_SRGGB8, 1),
    bayer16(V4L2_PIX_FMT_SBGGR16, 1),
    bayer16(V4L2_PIX_FMT_SGBRG16, 0),
    bayer16(V4L2_PIX_FMT_SGRBG16, 0),
    bayer16(V4L2_PIX_FMT_SRGGB16, 1),
    bayer12_packed(V4L2_PIX_FMT_SBGGR12P, 1),
    bayer12_packed(V4L2_PIX_FMT_SGBRG12P, 0),
    bayer12_packed(V4L2_PIX_FMT_SGRBG12P, 0),
    bayer12_packed(V4L2_PIX_FMT_SRGGB12P, 1),
    bayer_words(V4L2_PIX_FMT_SBGGR10, 10, 1),
    bayer_words(V4L2_PIX_FMT_SGBRG10, 10, 0),
    bayer_words(V4L2_PIX_FMT_SGRBG10, 10, 0),
    bayer_words(V4L2_PIX_FMT_SRGGB10, 10, 1),
    bayer_words(V4L2_PIX_FMT_SBGGR12, 12, 1),
    bayer_words(V4L2_PIX_FMT_SGBRG12, 12, 0),
    bayer_words(V4L2_PIX_FMT_SGRBG12, 12, 0),
    bayer_words(V4L2_PIX_FMT_SRGGB12, 12, 1),
    bayer_words(V4L2_PIX_FMT_SBGGR14, 14, 1),
    bayer_words(V4L2_PIX_FMT_SGBRG14, 14, 0),
    bayer_words(V4L2_PIX_FMT_SGRBG14, 14, 0),
    bayer_words(V4L2_PIX_FMT_SRGGB14, 14, 1),
    bayer10_packed(V4L2_PIX_FMT_SBGGR10P, 1),
    bayer10_packed(V4L2_PIX_FMT_SGBRG10P, 0),
    bayer10_packed(V4L2_PIX_FMT_SGRBG10P, 0),
    bayer10_packed(V4L2_PIX_FMT_SRGGB10P, 1),
    // Decoding.
    PixelFormat{V4L2_PIX_FMT_MJPEG, Reading::kJpeg, 0, 1, 0, 1, 0},
    PixelFormat{V4L2_PIX_FMT_JPEG, Reading::kJpeg, 0, 1, 0, 1, 0},
};

constexpr std::uint32_t kBigEndian = 1U << 31;

}  // namespace

std::span<const PixelFormat> pixel_formats() {
  return kFormats;
}

const PixelFormat* find_pixel_format(std::uint32_t fourcc) {
  for (const PixelFormat& format : kFormats) {
    if (format.fourcc == fourcc) return &format;
  }
  return nullptr;
}

int cost_rank(const PixelFormat& format) {
  return static_cast<int>(find_pixel_format(format.fourcc) - kFormats.data());
}

std::string fourcc_name(std::uint32_t fourcc) {
  std::string name;
  for (int byte = 0; byte < 4; ++byte) {
    const auto c = static_cast<char>((fourcc >> (8 * byte)) & 0x7f);
    name += c >= 0x20 && c < 0x7f ? c : '?';
  }
  name.erase(name.find_last_not_of(' ') + 1);
  return (fourcc & kBigEndian) != 0 ? name + "-BE" : name;
}

std::optional<std::uint32_t> parse_fourcc(std::string_view name) {
  std::uint32_t fourcc = 0;
  if (name.ends_with("-BE")) {
    fourcc = kBigEndian;
    name.remove_suffix(3);
  }
  if (name.empty() || name.size() > 4) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i) {
    const char c = i < name.size() ? name[i] : ' ';
    if (c < 0x20 || c >= 0x7f) return std::nullopt;
    fourcc |= static_cast<std::uint32_t>(c) << (8 * i);
  }
  return fourcc;
}

std::string_view how_it_is_read(const PixelFormat& format) {
  switch (format.reading) {
    case Reading::kInPlace:
      return format.cell == 1 ? "read in place" : "green sites, read in place";
    case Reading::kWords:
    case Reading::kPacked10:
      return format.cell == 1 ? "reduced to 8 bits" : "green sites, reduced to 8 bits";
    case Reading::kJpeg:
      return "decoded, luma alone";
  }
  return "";
}

}  // namespace roundel
