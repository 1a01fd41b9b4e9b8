#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/image_codecs.hpp"

namespace roundel {
namespace {

constexpr int kAdam7Passes = 7;

// libpng's errors leave by longjmp. So no function that calls it owns anything; what is to be
// released belongs to the decoder.
class PngDecoder {
 public:
  explicit PngDecoder(std::span<const std::uint8_t> bytes) : rest_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore_warning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, this, read);
  }
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;

  unsigned width() const { return png_get_image_width(png_, info_); }
  unsigned height() const { return png_get_image_height(png_, info_); }
  const char* message() const { return message_; }

  // Both return false where libpng is not content; message() tells why.
  bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) {  // NOLINT(cert-err52-cpp)
      return false;
    }
    png_read_info(png_, info_);
    png_set_expand(png_);    // palettes, fewer than 8 bits, transparency chunks
    png_set_scale_16(png_);  // 16 bits, rounded
    interlaced_ = png_get_interlace_type(png_, info_) == PNG_INTERLACE_ADAM7;
    png_read_update_info(png_, info_);
    channels_ = png_get_channels(png_, info_);
    return true;
  }

  // `row` holds a row of pixels with all their channels: row_bytes().
  bool read_luma(std::uint8_t* row, GreyImage& image) {
    if (setjmp(png_jmpbuf(png_)) != 0) {  // NOLINT(cert-err52-cpp)
      return false;
    }
    if (interlaced_) {
      for (int pass = 0; pass < kAdam7Passes; ++pass) {
        read_pass(pass, row, image);
      }
    } else {
      for (int v = 0; v < image.height; ++v) {
        png_read_row(png_, row, nullptr);
        take_row(row, image.width, 1, image.pixels.data() + offset(image, v));
      }
    }
    png_read_end(png_, nullptr);
    return true;
  }

  std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }

 private:
  static std::size_t offset(const GreyImage& image, int v) {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width);
  }

  // Without libpng's interlace handling it hands out every pass as a small image of its own: no
  // copy of the whole picture in colour is needed.
  void read_pass(int pass, std::uint8_t* row, GreyImage& image) {
    const auto rows = static_cast<int>(PNG_PASS_ROWS(height(), pass));
    const auto columns = static_cast<int>(PNG_PASS_COLS(width(), pass));
    if (columns == 0) {
      return;  // libpng leaves out such passes altogether
    }
    const int step = static_cast<int>(PNG_PASS_COL_OFFSET(pass));
    for (int i = 0; i < rows; ++i) {
      const int v = static_cast<int>(PNG_ROW_FROM_PASS_ROW(i, pass));
      png_read_row(png_, row, nullptr);
      take_row(row, columns, step,
               image.pixels.data() + offset(image, v) + PNG_PASS_START_COL(pass));
    }
  }

  // Luma of `count` pixels into every step-th byte.
  void take_row(const std::uint8_t* row, int count, int step, std::uint8_t* luma) const {
    const bool colour = channels_ >= 3;
    const bool alpha = channels_ == 2 || channels_ == 4;
    for (int i = 0; i < count; ++i, row += channels_, luma += step) {
      unsigned value = row[0];
      if (colour) {  // BT.601, as cameras do it
        value = (19595U * row[0] + 38470U * row[1] + 7471U * row[2] + 32768U) >> 16;
      }
      if (alpha) {
        const unsigned opacity = row[channels_ - 1];
        value = (value * opacity + 255U * (255U - opacity) + 127U) / 255U;
      }
      *luma = static_cast<std::uint8_t>(value);
    }
  }

  static void read(png_structp png, png_bytep data, std::size_t count) {
    auto& self = *static_cast<PngDecoder*>(png_get_io_ptr(png));
    if (count > self.rest_.size()) {
      png_error(png, "the file ends too early");
    }
    std::copy_n(self.rest_.begin(), count, data);
    self.rest_ = self.rest_.subspan(count);
  }

  [[noreturn]] static void fail(png_structp png, png_const_charp message) {
    auto& self = *static_cast<PngDecoder*>(png_get_error_ptr(png));
    std::strncpy(self.message_, message, sizeof self.message_ - 1);
    png_longjmp(png, 1);
  }
  static void ignore_warning(png_structp, png_const_charp) {}

  std::span<const std::uint8_t> rest_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int channels_ = 0;
  bool interlaced_ = false;
  char message_[200] = {};
};

[[noreturn]] void fail_to_decode(const PngDecoder& decoder) {
  throw std::runtime_error(std::string("is truncated or damaged (PNG: ") + decoder.message() + ")");
}

}  // namespace

void decode_png(std::span<const std::uint8_t> bytes, GreyImage& image) {
  PngDecoder decoder(bytes);
  if (!decoder.read_header()) {
    fail_to_decode(decoder);
  }
  check_image_size(decoder.width(), decoder.height());
  image.resize(static_cast<int>(decoder.width()), static_cast<int>(decoder.height()));
  std::vector<std::uint8_t> row(decoder.row_bytes());
  if (!decoder.read_luma(row.data(), image)) {
    fail_to_decode(decoder);
  }
}

}  // namespace roundel
