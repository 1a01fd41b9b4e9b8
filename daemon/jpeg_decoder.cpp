#include "daemon/jpeg_decoder.hpp"

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it first
#include <cstring>
#include <new>

#include <jpeglib.h>

#include <jerror.h>

namespace roundel {
namespace {

// Bounds what a small file with a large header can make libjpeg allocate.
constexpr long kMaxDecoderBytes = 2L << 30;

constexpr int kMostScans = 100;  // ten are usual

struct ErrorManager {
  jpeg_error_mgr base;  // first: libjpeg knows this part only
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void fail(j_common_ptr info) {
  auto* errors = reinterpret_cast<ErrorManager*>(info->err);
  (*info->err->format_message)(info, errors->message);
  std::longjmp(errors->jump, 1);
}

// Warnings are how libjpeg tells of truncated and corrupt data, and it goes on with grey: for us
// they are errors. Stray bytes between segments do no harm.
void on_message(j_common_ptr info, int level) {
  if (level < 0 && info->err->msg_code != JWRN_EXTRANEOUS_DATA) fail(info);
}

// Called between pieces of a picture of several scans.
void on_progress(j_common_ptr info) {
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= kMostScans) return;
  auto* errors = reinterpret_cast<ErrorManager*>(info->err);
  std::strcpy(errors->message, "it has too many scans");
  std::longjmp(errors->jump, 1);
}

}  // namespace

// libjpeg must not be returned to after an error: out by longjmp. So no function that calls it owns
// anything; what is to be released belongs to the state.
struct JpegDecoder::State {
  State() {
    info.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = fail;
    errors.base.emit_message = on_message;
  }
  ~State() { jpeg_destroy_decompress(&info); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  bool create() {
    if (setjmp(errors.jump) != 0) return false;  // NOLINT(cert-err52-cpp)
    jpeg_create_decompress(&info);
    progress.progress_monitor = on_progress;
    info.progress = &progress;
    info.mem->max_memory_to_use = kMaxDecoderBytes;
    return true;
  }

  bool read_header(const std::uint8_t* data, std::size_t size) {
    jpeg_abort_decompress(&info);                // whatever became of the picture before
    if (setjmp(errors.jump) != 0) return false;  // NOLINT(cert-err52-cpp)
    jpeg_mem_src(&info, data, size);
    jpeg_read_header(&info, TRUE);
    return true;
  }

  bool read_luma(std::uint8_t* pixels) {
    if (setjmp(errors.jump) != 0) return false;  // NOLINT(cert-err52-cpp)
    info.out_color_space = JCS_GRAYSCALE;
    jpeg_start_decompress(&info);
    while (info.output_scanline < info.output_height) {
      JSAMPROW row = pixels + std::size_t{info.output_scanline} * info.output_width;
      jpeg_read_scanlines(&info, &row, 1);
    }
    jpeg_finish_decompress(&info);
    return true;
  }

  ErrorManager errors = {};
  jpeg_progress_mgr progress = {};
  jpeg_decompress_struct info = {};
};

JpegDecoder::JpegDecoder() : state_(std::make_unique<State>()) {
  if (!state_->create()) throw std::bad_alloc();
}
JpegDecoder::~JpegDecoder() = default;
JpegDecoder::JpegDecoder(JpegDecoder&&) noexcept = default;
JpegDecoder& JpegDecoder::operator=(JpegDecoder&&) noexcept = default;

bool JpegDecoder::read_header(std::span<const std::uint8_t> bytes) {
  return state_->read_header(bytes.data(), bytes.size());
}
bool JpegDecoder::read_luma(std::uint8_t* pixels) {
  return state_->read_luma(pixels);
}
unsigned JpegDecoder::width() const {
  return state_->info.image_width;
}
unsigned JpegDecoder::height() const {
  return state_->info.image_height;
}
bool JpegDecoder::in_one_scan() const {
  return jpeg_has_multiple_scans(&state_->info) == FALSE;
}
const char* JpegDecoder::message() const {
  return state_->errors.message;
}

}  // namespace roundel
