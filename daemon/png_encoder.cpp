#include <png.h>

#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/file_pointer.hpp"
#include "daemon/image_file.hpp"

namespace roundel {
namespace {

// As PngDecoder: errors leave libpng by longjmp.
class PngEncoder {
 public:
  explicit PngEncoder(std::FILE* file) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore_warning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
    png_init_io(png_, file);
  }
  ~PngEncoder() { png_destroy_write_struct(&png_, &info_); }
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  const char* message() const { return message_; }

  // `row` has room for one row. Returns false where libpng is not content; message() tells why.
  bool write(const LumaView& image, double pixels_per_metre, std::uint8_t* row) {
    if (setjmp(png_jmpbuf(png_)) != 0) {  // NOLINT(cert-err52-cpp)
      return false;
    }
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(image.width),
                 static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (pixels_per_metre > 0) {
      const auto density = static_cast<png_uint_32>(std::lround(pixels_per_metre));
      png_set_pHYs(png_, info_, density, density, PNG_RESOLUTION_METER);
    }
    png_write_info(png_, info_);
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        row[u] = image.at(u, v);
      }
      png_write_row(png_, row);
    }
    png_write_end(png_, nullptr);
    return true;
  }

 private:
  [[noreturn]] static void fail(png_structp png, png_const_charp message) {
    auto& self = *static_cast<PngEncoder*>(png_get_error_ptr(png));
    std::strncpy(self.message_, message, sizeof self.message_ - 1);
    png_longjmp(png, 1);
  }
  static void ignore_warning(png_structp, png_const_charp) {}

  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char message_[200] = {};
};

}  // namespace

void save_png(const std::string& path, const LumaView& image, double pixels_per_metre) {
  const auto fail_to_write = [&](const char* why) {
    throw std::runtime_error(path + " can't be written: " + why);
  };
  FilePointer file(std::fopen(path.c_str(), "wbe"));
  if (!file) {
    fail_to_write(std::strerror(errno));
  }
  std::vector<std::uint8_t> row(static_cast<std::size_t>(image.width));
  {
    PngEncoder encoder(file.get());
    if (!encoder.write(image, pixels_per_metre, row.data())) {
      fail_to_write(encoder.message());
    }
  }
  if (std::fclose(file.release()) != 0) {
    fail_to_write(std::strerror(errno));
  }
}

}  // namespace roundel
