#include "daemon/capture/luma_reader.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstring>

#include "daemon/capture/video_device.hpp"

namespace roundel {
namespace {

constexpr int kMaxSide = 16384;

// The loops are separate so that the first, the usual one, is vectorised.
void reduce_words(const std::uint8_t* in, int step, int shift, std::span<std::uint8_t> out) {
  const auto word = [&](std::size_t i) {
    return static_cast<std::uint8_t>((in[2 * i] | in[2 * i + 1] << 8) >> shift);
  };
  if (step == 1) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = word(i);
  } else {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = word(i * static_cast<std::size_t>(step));
  }
}

// first: the pixel of the row where reading begins.
void gather_packed10(const std::uint8_t* row, int first, int step, std::span<std::uint8_t> out) {
  auto pixel = static_cast<std::size_t>(first);
  std::size_t i = 0;
  if (step == 1 && first % 4 == 0) {  // whole groups, five times as fast
    for (; i + 4 <= out.size(); i += 4, pixel += 4) {
      std::memcpy(out.data() + i, row + pixel / 4 * 5, 4);
    }
  }
  for (; i < out.size(); ++i, pixel += static_cast<std::size_t>(step)) {
    out[i] = row[pixel / 4 * 5 + pixel % 4];
  }
}

}  // namespace

LumaReader::LumaReader(const FrameLayout& layout, const Crop& crop) : layout_(layout), crop_(crop) {
  const PixelFormat& format = layout_.format;
  if (layout_.width < format.cell || layout_.height < format.cell || layout_.width > kMaxSide ||
      layout_.height > kMaxSide) {
    throw CameraError(fmt::format("its frames have {}x{} pixels; 1 to {} each way can be read",
                                  layout_.width, layout_.height, kMaxSide));
  }
  if (crop_.empty()) crop_ = {0, 0, layout_.width, layout_.height};
  if (crop_.left < 0 || crop_.top < 0 || crop_.width < format.cell || crop_.height < format.cell ||
      crop_.width > layout_.width - crop_.left || crop_.height > layout_.height - crop_.top) {
    throw CameraError(fmt::format("the crop {}x{} at ({}, {}) does not fit its frames of {}x{}",
                                  crop_.width, crop_.height, crop_.left, crop_.top, layout_.width,
                                  layout_.height));
  }
  // Else red and blue would take the place of green.
  crop_.left -= crop_.left % format.cell;
  crop_.top -= crop_.top % format.cell;
  if (format.reading == Reading::kJpeg) {
    decoder_.emplace();
    return;
  }
  const int least = (layout_.width * format.bits_per_pixel + 7) / 8;
  if (layout_.row_stride == 0) layout_.row_stride = least;
  if (layout_.row_stride < least) {
    throw CameraError(fmt::format("its driver says that a row of {} pixels {} has {} bytes",
                                  layout_.width, fourcc_name(format.fourcc), layout_.row_stride));
  }
  if (!in_place()) image_.resize(width(), height());
}

// All rows that can hold luma. What follows (chroma) may be missing.
std::size_t LumaReader::needed_bytes() const {
  const auto stride = static_cast<std::size_t>(layout_.row_stride);
  const auto last_row =
      static_cast<std::size_t>(layout_.width * layout_.format.bits_per_pixel + 7) / 8;
  return stride * static_cast<std::size_t>(layout_.height - 1) + last_row;
}

std::optional<LumaView> LumaReader::read(std::span<const std::uint8_t> frame) {
  if (layout_.format.reading == Reading::kJpeg) return decode(frame);
  if (frame.size() < needed_bytes()) return std::nullopt;
  return in_place() ? view_in_place(frame.data()) : gather(frame.data());
}

LumaView LumaReader::view_in_place(const std::uint8_t* frame) const {
  const PixelFormat& format = layout_.format;
  const auto stride = static_cast<std::ptrdiff_t>(layout_.row_stride);
  const std::ptrdiff_t start =
      crop_.top * stride + crop_.left / format.cell * format.pixel_stride + format.offset;
  return {frame + start, width(), height(), stride * format.cell, format.pixel_stride};
}

LumaView LumaReader::gather(const std::uint8_t* frame) {
  const PixelFormat& format = layout_.format;
  const auto columns = static_cast<std::size_t>(width());
  const int first = crop_.left + format.offset;
  for (int v = 0; v < height(); ++v) {
    const std::uint8_t* const row =
        frame + static_cast<std::ptrdiff_t>(crop_.top + v * format.cell) * layout_.row_stride;
    const std::span out(image_.pixels.data() + static_cast<std::size_t>(v) * columns, columns);
    if (format.reading == Reading::kWords) {
      reduce_words(row + 2 * static_cast<std::ptrdiff_t>(first), format.pixel_stride, format.shift,
                   out);
    } else {
      gather_packed10(row, first, format.pixel_stride, out);
    }
  }
  return image_.view();
}

std::optional<LumaView> LumaReader::decode(std::span<const std::uint8_t> frame) {
  if (!decoder_->read_header(frame)) return std::nullopt;
  const auto width = static_cast<std::uint64_t>(layout_.width);
  const auto height = static_cast<std::uint64_t>(layout_.height);
  if (decoder_->width() != width || decoder_->height() != height) return std::nullopt;
  if (!decoder_->in_one_scan()) return std::nullopt;  // no camera's; takes long to decode
  image_.resize(layout_.width, layout_.height);
  if (!decoder_->read_luma(image_.pixels.data())) return std::nullopt;
  const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(crop_.top) * layout_.width + crop_.left;
  return grey_view(image_.pixels.data() + start, crop_.width, crop_.height, layout_.width);
}

}  // namespace roundel
