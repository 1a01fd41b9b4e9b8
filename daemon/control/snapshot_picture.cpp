#include "daemon/control/snapshot_picture.hpp"

#include <cstdio>  // jpeglib.h needs it first

#include <fmt/format.h>
#include <jpeglib.h>

#include <csetjmp>
#include <cstdlib>
#include <stdexcept>

#include "daemon/draw_arena.hpp"
#include "daemon/draw_markers.hpp"

namespace roundel {
namespace {

struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf back;
};

// libjpeg leaves by longjmp when something is wrong: nothing here has a destructor.
bool compress(const unsigned char* pixels, int width, int height, int stride, unsigned char** out,
              unsigned long* size) {
  constexpr int kQuality = 90;
  jpeg_compress_struct info{};
  JpegErrors errors{};
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = [](j_common_ptr common) {
    std::longjmp(reinterpret_cast<JpegErrors*>(common->err)->back, 1);
  };
  if (setjmp(errors.back) != 0) {
    jpeg_destroy_compress(&info);
    return false;
  }
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, out, size);
  info.image_width = static_cast<JDIMENSION>(width);
  info.image_height = static_cast<JDIMENSION>(height);
  info.input_components = 4;
  // Cairo's pixels are numbers 0x00RRGGBB.
  info.in_color_space = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? JCS_EXT_BGRX : JCS_EXT_XRGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, kQuality, TRUE);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    auto* row = const_cast<JSAMPROW>(  // NOLINT(cppcoreguidelines-pro-type-const-cast): not written
        pixels + static_cast<std::ptrdiff_t>(info.next_scanline) * stride);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

std::string jpeg_of(cairo_surface_t* surface) {
  cairo_surface_flush(surface);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  const bool whole =
      compress(cairo_image_surface_get_data(surface), cairo_image_surface_get_width(surface),
               cairo_image_surface_get_height(surface), cairo_image_surface_get_stride(surface),
               &data, &size);
  std::string result;
  if (whole) result.assign(reinterpret_cast<const char*>(data), size);
  std::free(data);
  if (!whole) throw std::runtime_error("the picture can't be compressed");
  return result;
}

std::string png_of(cairo_surface_t* surface) {
  std::string result;
  const auto append = [](void* out, const unsigned char* data, unsigned int size) {
    static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
  };
  if (cairo_surface_write_to_png_stream(surface, append, &result) != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error("the picture can't be compressed");
  }
  return result;
}

std::string pgm_of(const GreyImage& picture) {
  std::string result = fmt::format("P5\n{} {}\n255\n", picture.width, picture.height);
  result.append(picture.pixels.begin(), picture.pixels.end());
  return result;
}

}  // namespace

std::string encode_picture(const FrameSnapshot& frame, PictureFormat format, bool overlay) {
  if (format == PictureFormat::kPgm) return pgm_of(frame.picture);
  const CairoSurface surface = grey_surface(frame.picture.view());
  if (overlay) {
    const CairoContext context(cairo_create(surface.get()));
    const TrackingContext& tracking = *frame.context;
    if (tracking.arena_in_use()) draw_arena(context.get(), *tracking.calibration);
    draw_found_markers(context.get(), frame.markers, tracking.camera, tracking.diameter_m);
  }
  return format == PictureFormat::kPng ? png_of(surface.get()) : jpeg_of(surface.get());
}

}  // namespace roundel
