#pragma once

#include <cstdint>
#include <cstdio>  // jpeglib.h needs it first
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

namespace roundel {

// An evenly grey picture as a JPEG with colour, as cameras send it.
inline std::vector<std::uint8_t> jpeg_bytes(unsigned width, unsigned height, std::uint8_t luma) {
  jpeg_error_mgr errors;
  jpeg_compress_struct info;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = width;
  info.image_height = height;
  info.input_components = 3;
  info.in_color_space = JCS_YCbCr;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 100, TRUE);
  jpeg_start_compress(&info, TRUE);
  std::vector<std::uint8_t> row(std::size_t{3} * width, 128);
  for (std::size_t u = 0; u < width; ++u) row[3 * u] = luma;
  while (info.next_scanline < info.image_height) {
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
