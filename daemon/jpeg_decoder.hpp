#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace roundel {

// Decodes the luma of JPEG pictures, one after another. Colour is neither upsampled nor converted.
// Whatever the bytes are, it ends soon: every scan of a picture costs a pass over all of it, so
// those with very many are refused. What is truncated or damaged is refused, not filled up with
// grey. Pictures without Huffman tables, as in MJPEG, get the standard ones.
class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();
  JpegDecoder(JpegDecoder&&) noexcept;
  JpegDecoder& operator=(JpegDecoder&&) noexcept;

  // Both return false where libjpeg is not content; message() tells why. The bytes must stay until
  // read_luma() is done.
  bool read_header(std::span<const std::uint8_t> bytes);
  bool read_luma(std::uint8_t* pixels);  // room for width() * height()

  unsigned width() const;
  unsigned height() const;
  bool in_one_scan() const;  // as all of MJPEG is
  const char* message() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roundel
