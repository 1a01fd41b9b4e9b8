#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "daemon/capture/camera_mode.hpp"

namespace roundel {
namespace {

constexpr int kLargestWidth = 1920, kLargestHeight = 1080;  // taken unless asked for

struct Candidate {
  const PixelFormat* format;
  int width, height;
  double fastest;  // 0: unknown

  // Within what drivers round: 29.97 is 30.
  bool reaches(double rate) const { return fastest == 0 || fastest > 0.95 * rate; }
  bool fits() const { return width <= kLargestWidth && height <= kLargestHeight; }
  int area() const { return width * height; }
};

std::string names(const std::vector<OfferedFormat>& offered) {
  std::vector<std::string> texts;
  for (const OfferedFormat& format : offered) {
    if (!format.emulated) texts.push_back(fourcc_name(format.fourcc));
  }
  return texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, ", "));
}

std::string sizes(const std::vector<OfferedFormat>& offered) {
  std::set<std::pair<int, int>> all;
  for (const OfferedFormat& format : offered) {
    for (const OfferedSize& size : format.sizes) all.emplace(size.width, size.height);
  }
  std::vector<std::string> texts;
  texts.reserve(all.size());
  for (const auto& [width, height] : all) texts.push_back(fmt::format("{}x{}", width, height));
  return fmt::format("{}", fmt::join(texts, ", "));
}

// Emulated formats only where there is no native one.
std::vector<OfferedFormat> readable(const std::vector<OfferedFormat>& offered,
                                    std::uint32_t fourcc) {
  for (const bool emulated : {false, true}) {
    std::vector<OfferedFormat> found;
    for (const OfferedFormat& format : offered) {
      if (format.emulated == emulated && find_pixel_format(format.fourcc) != nullptr &&
          (fourcc == 0 || format.fourcc == fourcc)) {
        found.push_back(format);
      }
    }
    if (!found.empty()) return found;
  }
  return {};
}

std::vector<Candidate> candidates(const std::vector<OfferedFormat>& formats,
                                  const ModeRequest& request) {
  std::vector<Candidate> all;
  for (const OfferedFormat& offered : formats) {
    const PixelFormat* const format = find_pixel_format(offered.fourcc);
    if (offered.sizes.empty()) all.push_back({format, request.width, request.height, 0});
    for (const OfferedSize& size : offered.sizes) {
      const bool wanted = (request.width == 0 || request.width == size.width) &&
                          (request.height == 0 || request.height == size.height);
      if (wanted) all.push_back({format, size.width, size.height, size.fastest()});
    }
  }
  return all;
}

}  // namespace

ModeChoice choose_mode(const std::vector<OfferedFormat>& offered, const ModeRequest& request) {
  const std::vector<OfferedFormat> formats = readable(offered, request.fourcc);
  if (formats.empty()) {
    throw CameraError(request.fourcc == 0
                          ? fmt::format("no format of it can be read; it has {}", names(offered))
                          : fmt::format("it has no format {}; it has {}",
                                        fourcc_name(request.fourcc), names(offered)));
  }
  const std::vector<Candidate> all = candidates(formats, request);
  if (all.empty()) {
    const auto side = [](int length) { return length == 0 ? "any" : fmt::format("{}", length); };
    throw CameraError(fmt::format("it has no frames of {}x{}; it has {}", side(request.width),
                                  side(request.height), sizes(formats)));
  }
  // First the size, then the format; a slower one only if all are.
  const auto value = [&](const Candidate& c) {
    const bool reaches = c.reaches(request.frame_rate);
    return std::tuple(c.fits(), reaches, reaches ? c.area() : 0, reaches ? 0 : c.fastest,
                      c.fits() ? c.area() : -c.area(), -cost_rank(*c.format));
  };
  const Candidate best = *std::max_element(
      all.begin(), all.end(),
      [&](const Candidate& a, const Candidate& b) { return value(a) < value(b); });
  return {best.format, best.width, best.height};
}

}  // namespace roundel
