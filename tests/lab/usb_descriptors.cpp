#include "tests/lab/usb_descriptors.hpp"

#include <array>
#include <initializer_list>

namespace roundel {
namespace {

// The tables of the USB video class 1.0 (sections 3.7 to 3.9), in its own byte order.
void add8(UsbBytes& out, std::initializer_list<int> values) {
  for (const int value : values) out.push_back(static_cast<std::uint8_t>(value));
}
void add16(UsbBytes& out, std::uint32_t value) {
  add8(out, {static_cast<int>(value & 0xff), static_cast<int>(value >> 8 & 0xff)});
}
void add32(UsbBytes& out, std::uint32_t value) {
  add16(out, value & 0xffff);
  add16(out, value >> 16);
}
void append(UsbBytes& out, const UsbBytes& more) {
  out.insert(out.end(), more.begin(), more.end());
}

constexpr int kInterface = 0x24, kInputHeader = 1, kUncompressed = 4, kUncompressedFrame = 5,
              kMjpeg = 6, kMjpegFrame = 7, kColours = 0x0d;
constexpr int kEndpoint = 0x81;

int bits_per_pixel(UsbFormat format) {
  switch (format) {
    case UsbFormat::kYuyv:
      return 16;
    case UsbFormat::kNv12:
      return 12;
    case UsbFormat::kBgr:
      return 24;
    default:
      return 8;
  }
}

void add_guid(UsbBytes& out, UsbFormat format) {
  if (format == UsbFormat::kBgr) {
    add8(out, {0x7d, 0xeb, 0x36, 0xe4, 0x4f, 0x52, 0xce, 0x11, 0x9f, 0x53, 0x00, 0x20, 0xaf, 0x0b,
               0xa7, 0x70});
    return;
  }
  const char* const name = format == UsbFormat::kGrey   ? "Y800"
                           : format == UsbFormat::kYuyv ? "YUY2"
                                                        : "NV12";
  add8(out, {name[0], name[1], name[2], name[3], 0x00, 0x00, 0x10, 0x00, 0x80, 0x00, 0x00, 0xaa,
             0x00, 0x38, 0x9b, 0x71});
}

void add_format(UsbBytes& out, const UsbCameraDescription& camera, UsbFormat format, int number) {
  const bool jpeg = format == UsbFormat::kJpeg;
  if (jpeg) {
    add8(out, {11, kInterface, kMjpeg, number, 1, 1, 1, 0, 0, 0, 0});
  } else {
    add8(out, {27, kInterface, kUncompressed, number, 1});
    add_guid(out, format);
    add8(out, {bits_per_pixel(format), 1, 0, 0, 0, 0});
  }
  const auto rates = static_cast<int>(camera.frame_rates.size());
  const std::uint32_t bytes = camera.frame_bytes(format);
  add8(out, {26 + 4 * rates, kInterface, jpeg ? kMjpegFrame : kUncompressedFrame, 1, 0});
  add16(out, static_cast<std::uint32_t>(camera.width));
  add16(out, static_cast<std::uint32_t>(camera.height));
  add32(out, bytes * 8);
  add32(out, bytes * 8 * 60);
  add32(out, bytes);
  add32(out, interval_100ns(camera.frame_rates.front()));
  add8(out, {rates});
  for (const int rate : camera.frame_rates) add32(out, interval_100ns(rate));
  add8(out, {6, kInterface, kColours, 1, 1, 4});
}

UsbBytes streaming_interface(const UsbCameraDescription& camera) {
  const auto formats = static_cast<int>(camera.formats.size());
  UsbBytes body;
  int number = 0;
  for (const UsbFormat format : camera.formats) add_format(body, camera, format, ++number);
  UsbBytes out;
  add8(out, {13 + formats, kInterface, kInputHeader, formats});
  add16(out, static_cast<std::uint32_t>(static_cast<int>(body.size()) + 13 + formats));
  add8(out, {kEndpoint, 0, 2, 0, 0, 0, 1});
  for (int i = 0; i < formats; ++i) add8(out, {0});
  append(out, body);
  return out;
}

// A camera terminal with exposure mode, priority and time, and an output terminal.
UsbBytes control_interface() {
  constexpr int kExposureControls = 0x0e;
  UsbBytes terminals;
  add8(terminals, {18, kInterface, 2, kUsbCameraTerminal});
  add16(terminals, 0x0201);
  add8(terminals, {0, 0, 0, 0, 0, 0, 0, 0, 3, kExposureControls, 0, 0});
  add8(terminals, {9, kInterface, 3, 2});
  add16(terminals, 0x0101);
  add8(terminals, {0, kUsbCameraTerminal, 0});
  UsbBytes out;
  add8(out, {13, kInterface, 1});
  add16(out, 0x0100);
  add16(out, static_cast<std::uint32_t>(13 + terminals.size()));
  add32(out, 48'000'000);
  add8(out, {1, 1});
  append(out, terminals);
  return out;
}

}  // namespace

std::uint32_t UsbCameraDescription::frame_bytes(UsbFormat format) const {
  return static_cast<std::uint32_t>(width * height * bits_per_pixel(format) / 8);
}

std::uint32_t interval_100ns(int frame_rate) {
  return 10'000'000U / static_cast<std::uint32_t>(frame_rate);
}

UsbBytes device_descriptor() {
  return {18, 1, 0, 2, 0xef, 2, 1, 64, 0x6b, 0x1d, 0x02, 0x01, 0x10, 0, 1, 2, 3, 1};
}

UsbBytes configuration_descriptor(const UsbCameraDescription& camera) {
  UsbBytes out;
  add8(out, {9, 2, 0, 0, 2, 1, 0, 0x80, 250});
  add8(out, {8, 0x0b, 0, 2, 0x0e, 3, 0, 0});  // both interfaces are one function
  add8(out, {9, 4, 0, 0, 0, 0x0e, 1, 0, 0});  // control
  append(out, control_interface());
  add8(out, {9, 4, 1, 0, 1, 0x0e, 2, 0, 0});  // streaming
  append(out, streaming_interface(camera));
  add8(out, {7, 5, kEndpoint, 2, 0, 2, 0});  // bulk
  out[2] = static_cast<std::uint8_t>(out.size() & 0xff);
  out[3] = static_cast<std::uint8_t>(out.size() >> 8);
  return out;
}

UsbBytes string_descriptor(const std::string& text) {
  UsbBytes out;
  add8(out, {static_cast<int>(2 + 2 * text.size()), 3});
  for (const char c : text) add8(out, {c, 0});
  return out;
}

}  // namespace roundel
