#include "tests/lab/usb_pictures.hpp"

#include "tests/jpeg_bytes.hpp"

namespace roundel {
namespace {

constexpr std::uint8_t kNoColour = 128;
constexpr int kQuality = 95;

UsbBytes spread(const UsbBytes& luma, std::size_t stride, bool grey_elsewhere) {
  UsbBytes out(stride * luma.size(), kNoColour);
  for (std::size_t i = 0; i < luma.size(); ++i) {
    for (std::size_t k = 0; k < (grey_elsewhere ? stride : 1); ++k) out[stride * i + k] = luma[i];
  }
  return out;
}

}  // namespace

UsbBytes encode_picture(const GreyImage& picture, UsbFormat format) {
  UsbBytes luma = picture.pixels;
  switch (format) {
    case UsbFormat::kGrey:
      break;
    case UsbFormat::kYuyv:
      return spread(luma, 2, false);
    case UsbFormat::kNv12:
      luma.resize(luma.size() * 3 / 2, kNoColour);
      break;
    case UsbFormat::kBgr:
      return spread(luma, 3, true);
    case UsbFormat::kJpeg:
      return jpeg_bytes(picture, kQuality);
  }
  return luma;
}

}  // namespace roundel
