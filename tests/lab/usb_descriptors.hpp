#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace roundel {

using UsbBytes = std::vector<std::uint8_t>;

enum class UsbFormat : std::uint8_t { kGrey, kYuyv, kNv12, kBgr, kJpeg };

// Of the simulated USB camera (UVC 1.0, one bulk endpoint): what it says about itself.
struct UsbCameraDescription {
  std::vector<UsbFormat> formats;  // by their number in the protocol, from 1
  int width = 640, height = 480;
  std::vector<int> frame_rates = {30, 15};  // frames a second, descending
  std::string name = "Roundel lab";
  std::string serial = "LAB0001";

  std::uint32_t frame_bytes(UsbFormat format) const;  // JPEG: at most
};

// uvcvideo asks for bulk transfers of this size; each must be one payload with its header.
constexpr std::uint32_t kUsbPayload = 16384;
constexpr int kUsbCameraTerminal = 1;  // the entity with the exposure controls

std::uint32_t interval_100ns(int frame_rate);

UsbBytes device_descriptor();
UsbBytes configuration_descriptor(const UsbCameraDescription& camera);
UsbBytes string_descriptor(const std::string& text);

}  // namespace roundel
