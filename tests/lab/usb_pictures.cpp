#include "tests/lab/usb_pictures.hpp"

#include <cstdio>  // jpeglib.h needs it first
#include <cstdlib>

#include <jpeglib.h>

namespace roundel {
namespace {

constexpr std::uint8_t kNoColour = 128;

UsbBytes encode_jpeg(const GreyImage& picture) {
  constexpr int kQuality = 95;
  jpeg_error_mgr errors;
  jpeg_compress_struct info;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<JDIMENSION>(picture.width);
  info.image_height = static_cast<JDIMENSION>(picture.height);
  info.input_components = 3;
  info.in_color_space = JCS_YCbCr;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, kQuality, TRUE);
  jpeg_start_compress(&info, TRUE);
  UsbBytes row(3 * static_cast<std::size_t>(picture.width), kNoColour);
  while (info.next_scanline < info.image_height) {
    const std::uint8_t* const luma = picture.view().row(static_cast<int>(info.next_scanline));
    for (std::size_t u = 0; u < row.size() / 3; ++u) row[3 * u] = luma[u];
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&info, &pointer, 1);
  }
  jpeg_finish_compress(&info);
  UsbBytes result(bytes, bytes + size);
  std::free(bytes);
  jpeg_destroy_compress(&info);
  return result;
}

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
      return encode_jpeg(picture);
  }
  return luma;
}

}  // namespace roundel
