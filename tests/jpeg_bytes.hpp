#pragma once

#include <cstdint>
#include <cstdio>  // jpeglib.h needs it first
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

#include "core/grey_image.hpp"

namespace roundel {

enum class JpegScans : std::uint8_t { kOne, kOneForEachPlane, kProgressive };

// A grey picture as a JPEG with colour planes, as cameras send it.
inline std::vector<std::uint8_t> jpeg_bytes(const GreyImage& picture, int quality,
                                            JpegScans scans = JpegScans::kOne) {
  constexpr std::uint8_t kNoColour = 128;
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
  jpeg_set_quality(&info, quality, TRUE);
  if (scans == JpegScans::kProgressive) jpeg_simple_progression(&info);
  static constexpr jpeg_scan_info kPlanes[] = {
      {1, {0}, 0, 63, 0, 0}, {1, {1}, 0, 63, 0, 0}, {1, {2}, 0, 63, 0, 0}};
  if (scans == JpegScans::kOneForEachPlane) {
    info.scan_info = kPlanes;
    info.num_scans = 3;
  }
  jpeg_start_compress(&info, TRUE);
  std::vector<std::uint8_t> row(3 * static_cast<std::size_t>(picture.width), kNoColour);
  while (info.next_scanline < info.image_height) {
    const std::uint8_t* const luma = picture.view().row(static_cast<int>(info.next_scanline));
    for (std::size_t u = 0; u < row.size() / 3; ++u) row[3 * u] = luma[u];
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&info, &pointer, 1);
  }
  jpeg_finish_compress(&info);
  std::vector<std::uint8_t> result(bytes, bytes + size);
  std::free(bytes);
  jpeg_destroy_compress(&info);
  return result;
}

}  // namespace roundel
