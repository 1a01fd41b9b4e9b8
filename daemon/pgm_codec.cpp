#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "daemon/image_codecs.hpp"

namespace roundel {
namespace {

constexpr std::uint32_t kMaxValue = 65535;

// Walks over the text parts of a PGM file: numbers separated by white space and # comments.
class Scanner {
 public:
  explicit Scanner(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint32_t number(const char* what) {
    skip_space();
    std::uint32_t value = 0;
    const std::size_t start = at_;
    for (; at_ < bytes_.size() && std::isdigit(bytes_[at_]) != 0; ++at_) {
      value = value * 10 + (bytes_[at_] - std::uint32_t{'0'});
      if (value > 100'000'000) {
        throw std::runtime_error(fmt::format("has an impossible {} in its PGM header", what));
      }
    }
    if (at_ == start) {
      throw std::runtime_error(at_ == bytes_.size()
                                   ? fmt::format("is truncated: {} is missing", what)
                                   : fmt::format("is damaged: {} is not a number", what));
    }
    return value;
  }

  // The single white-space character between the header and binary samples.
  std::span<const std::uint8_t> rest_after_space() {
    if (at_ >= bytes_.size()) {
      throw std::runtime_error("is truncated: it ends within the PGM header");
    }
    if (std::isspace(bytes_[at_]) == 0) {
      throw std::runtime_error("is damaged: the PGM header does not end with white space");
    }
    return bytes_.subspan(at_ + 1);
  }

  void skip(std::size_t count) { at_ += count; }

 private:
  void skip_space() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#') {
        while (at_ < bytes_.size() && bytes_[at_] != '\n') {
          ++at_;
        }
      } else if (std::isspace(bytes_[at_]) != 0) {
        ++at_;
      } else {
        return;
      }
    }
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

std::uint8_t to_8_bits(std::uint32_t value, std::uint32_t max_value) {
  if (value > max_value) {
    throw std::runtime_error(
        fmt::format("is damaged: the value {} is above its maximum {}", value, max_value));
  }
  return static_cast<std::uint8_t>((value * 255 + max_value / 2) / max_value);
}

void take_binary(std::span<const std::uint8_t> samples, std::uint32_t max_value, GreyImage& image) {
  const std::size_t wide = max_value > 255 ? 2 : 1;
  if (samples.size() < image.pixels.size() * wide) {
    throw std::runtime_error(fmt::format("is truncated: {} of {} bytes of pixels are there",
                                         samples.size(), image.pixels.size() * wide));
  }
  if (max_value == 255) {
    std::copy_n(samples.begin(), image.pixels.size(), image.pixels.begin());
    return;
  }
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::uint32_t value = wide == 1 ? samples[i]
                                          : static_cast<std::uint32_t>(samples[2 * i]) << 8 |
                                                static_cast<std::uint32_t>(samples[2 * i + 1]);
    image.pixels[i] = to_8_bits(value, max_value);
  }
}

}  // namespace

void decode_pgm(std::span<const std::uint8_t> bytes, GreyImage& image) {
  const bool plain = bytes[1] == '2';
  Scanner scanner(bytes);
  scanner.skip(2);
  const std::uint32_t width = scanner.number("width");
  const std::uint32_t height = scanner.number("height");
  check_image_size(width, height);
  const std::uint32_t max_value = scanner.number("maximum value");
  if (max_value == 0 || max_value > kMaxValue) {
    throw std::runtime_error(
        fmt::format("has a maximum value of {}; PGM has 1 to {}", max_value, kMaxValue));
  }
  // A plain sample takes two characters but for the last: no header can make us allocate more than
  // the file is worth.
  if (plain && bytes.size() / 2 + 1 < std::size_t{width} * height) {
    throw std::runtime_error("is truncated: fewer values than pixels");
  }
  if (!plain) {
    const auto samples = scanner.rest_after_space();
    if (samples.size() < std::size_t{width} * height) {
      throw std::runtime_error(
          fmt::format("is truncated: {} bytes of pixels for {}x{}", samples.size(), width, height));
    }
    image.resize(static_cast<int>(width), static_cast<int>(height));
    take_binary(samples, max_value, image);
    return;
  }
  image.resize(static_cast<int>(width), static_cast<int>(height));
  for (std::uint8_t& pixel : image.pixels) {
    pixel = to_8_bits(scanner.number("pixel value"), max_value);
  }
}

}  // namespace roundel
