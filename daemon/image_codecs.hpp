#pragma once

#include <cstdint>
#include <span>

#include "core/grey_image.hpp"

// The formats behind image_file.hpp. A decoder gets a whole file in memory and throws
// std::runtime_error with a sentence that does not name the file ("is truncated: ...").
namespace roundel {

void decode_png(std::span<const std::uint8_t> bytes, GreyImage& image);
void decode_jpeg(std::span<const std::uint8_t> bytes, GreyImage& image);
void decode_pgm(std::span<const std::uint8_t> bytes, GreyImage& image);

// Throws std::runtime_error unless both sides are in [1, kMaxImageSide].
void check_image_size(std::uint64_t width, std::uint64_t height);

}  // namespace roundel
