#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it first
#include <stdexcept>
#include <string>

#include <jpeglib.h>

#include <jerror.h>

#include "daemon/image_codecs.hpp"

namespace roundel {
namespace {

// Bounds what a small file with a large header can make libjpeg allocate.
constexpr long kMaxDecoderBytes = 2L << 30;

// libjpeg must not be returned to after an error: out by longjmp. So no function that calls it owns
// anything; what is to be released belongs to the decoder.
class JpegDecoder {
 public:
  explicit JpegDecoder(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
    info_.err = jpeg_std_error(&errors_.base);
    errors_.base.error_exit = fail;
    errors_.base.emit_message = on_message;
  }
  ~JpegDecoder() { jpeg_destroy_decompress(&info_); }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  unsigned width() const { return info_.image_width; }
  unsigned height() const { return info_.image_height; }
  const char* message() const { return errors_.message; }

  // Both return false where libjpeg is not content; message() tells why.
  bool read_header() {
    if (setjmp(errors_.jump) != 0) {  // NOLINT(cert-err52-cpp)
      return false;
    }
    jpeg_create_decompress(&info_);
    info_.mem->max_memory_to_use = kMaxDecoderBytes;
    jpeg_mem_src(&info_, bytes_.data(), bytes_.size());
    jpeg_read_header(&info_, TRUE);
    return true;
  }

  bool read_luma(std::uint8_t* pixels) {
    if (setjmp(errors_.jump) != 0) {  // NOLINT(cert-err52-cpp)
      return false;
    }
    info_.out_color_space = JCS_GRAYSCALE;
    jpeg_start_decompress(&info_);
    while (info_.output_scanline < info_.output_height) {
      JSAMPROW row = pixels + std::size_t{info_.output_scanline} * info_.output_width;
      jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_finish_decompress(&info_);
    return true;
  }

 private:
  struct ErrorManager {
    jpeg_error_mgr base;  // first: libjpeg knows this part only
    std::jmp_buf jump;
    char message[JMSG_LENGTH_MAX];
  };

  [[noreturn]] static void fail(j_common_ptr info) {
    auto* errors = reinterpret_cast<ErrorManager*>(info->err);
    (*info->err->format_message)(info, errors->message);
    std::longjmp(errors->jump, 1);
  }

  // Warnings are how libjpeg tells of truncated and corrupt data, and it goes on with grey: for us
  // they are errors. Stray bytes between segments do no harm.
  static void on_message(j_common_ptr info, int level) {
    if (level < 0 && info->err->msg_code != JWRN_EXTRANEOUS_DATA) {
      fail(info);
    }
  }

  std::span<const std::uint8_t> bytes_;
  ErrorManager errors_ = {};
  jpeg_decompress_struct info_ = {};
};

[[noreturn]] void fail_to_decode(const JpegDecoder& decoder) {
  throw std::runtime_error(std::string("is truncated or damaged (JPEG: ") + decoder.message() +
                           ")");
}

}  // namespace

void decode_jpeg(std::span<const std::uint8_t> bytes, GreyImage& image) {
  JpegDecoder decoder(bytes);
  if (!decoder.read_header()) {
    fail_to_decode(decoder);
  }
  check_image_size(decoder.width(), decoder.height());
  image.resize(static_cast<int>(decoder.width()), static_cast<int>(decoder.height()));
  if (!decoder.read_luma(image.pixels.data())) {
    fail_to_decode(decoder);
  }
}

}  // namespace roundel
