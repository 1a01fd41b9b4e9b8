#include <stdexcept>
#include <string>

#include "daemon/image_codecs.hpp"
#include "daemon/jpeg_decoder.hpp"

namespace roundel {
namespace {

[[noreturn]] void fail_to_decode(const JpegDecoder& decoder) {
  throw std::runtime_error(std::string("is truncated or damaged (JPEG: ") + decoder.message() +
                           ")");
}

}  // namespace

void decode_jpeg(std::span<const std::uint8_t> bytes, GreyImage& image) {
  JpegDecoder decoder;
  if (!decoder.read_header(bytes)) fail_to_decode(decoder);
  check_image_size(decoder.width(), decoder.height());
  image.resize(static_cast<int>(decoder.width()), static_cast<int>(decoder.height()));
  if (!decoder.read_luma(image.pixels.data())) fail_to_decode(decoder);
}

}  // namespace roundel
