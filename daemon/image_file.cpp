#include "daemon/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <span>
#include <stdexcept>

#include "daemon/file_pointer.hpp"
#include "daemon/image_codecs.hpp"

namespace roundel {
namespace {

using Decoder = void (*)(std::span<const std::uint8_t>, GreyImage&);

// No image within kMaxImageSide needs more; keeps an endless file from filling the memory.
constexpr std::size_t kMaxFileBytes = std::size_t{2} << 30;
constexpr std::size_t kMagicBytes = 8;

Decoder decoder_for(std::span<const std::uint8_t> start) {
  constexpr std::array<std::uint8_t, 8> kPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr std::array<std::uint8_t, 3> kJpeg = {0xff, 0xd8, 0xff};
  const auto starts_with = [&](const auto& magic) {
    return start.size() >= magic.size() && std::equal(magic.begin(), magic.end(), start.begin());
  };
  if (starts_with(kPng)) {
    return decode_png;
  }
  if (starts_with(kJpeg)) {
    return decode_jpeg;
  }
  if (start.size() >= 2 && start[0] == 'P' && (start[1] == '2' || start[1] == '5')) {
    return decode_pgm;
  }
  return nullptr;
}

// Appends up to `count` bytes; fewer only at the end of the file.
void read_more(std::FILE* file, std::size_t count, std::vector<std::uint8_t>& bytes) {
  const std::size_t before = bytes.size();
  bytes.resize(before + count);
  bytes.resize(before + std::fread(bytes.data() + before, 1, count, file));
  if (std::ferror(file) != 0) {
    throw std::runtime_error(fmt::format("can't be read: {}", std::strerror(errno)));
  }
}

void read_and_decode(const std::string& path, std::vector<std::uint8_t>& bytes, GreyImage& image) {
  const FilePointer file(std::fopen(path.c_str(), "rbe"));
  if (!file) {
    throw std::runtime_error(fmt::format("can't be opened: {}", std::strerror(errno)));
  }
  bytes.clear();
  read_more(file.get(), kMagicBytes, bytes);
  if (bytes.empty()) {
    throw std::runtime_error("is empty");
  }
  const Decoder decode = decoder_for(bytes);
  if (decode == nullptr) {
    throw std::runtime_error("is not an image that can be read (PNG, JPEG or PGM)");
  }
  for (std::size_t chunk = std::size_t{1} << 16; std::feof(file.get()) == 0; chunk *= 2) {
    if (bytes.size() > kMaxFileBytes) {
      throw std::runtime_error(fmt::format("is larger than {} MiB", kMaxFileBytes >> 20));
    }
    read_more(file.get(), chunk, bytes);
  }
  decode(bytes, image);
}

}  // namespace

void check_image_size(std::uint64_t width, std::uint64_t height) {
  if (width == 0 || height == 0) {
    throw std::runtime_error(fmt::format("has no pixels ({}x{})", width, height));
  }
  if (width > kMaxImageSide || height > kMaxImageSide) {
    throw std::runtime_error(fmt::format("is too large: {}x{}, at most {}x{} can be read", width,
                                         height, kMaxImageSide, kMaxImageSide));
  }
}

void ImageLoader::load(const std::string& path, GreyImage& image) {
  try {
    read_and_decode(path, bytes_, image);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{} {}", path, error.what()));
  }
}

GreyImage load_image(const std::string& path) {
  GreyImage image;
  ImageLoader().load(path, image);
  return image;
}

}  // namespace roundel
