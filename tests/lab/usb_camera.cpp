#include "tests/lab/usb_camera.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "daemon/capture/video_device.hpp"
#include "tests/lab/usb_pictures.hpp"
#include "transport/clock.hpp"

namespace roundel {
namespace {

// USB/IP: big-endian words; a reply repeats the number of its command.
constexpr std::uint32_t kSubmit = 1, kUnlink = 2, kSubmitReply = 3, kUnlinkReply = 4;
using Header = std::array<std::uint32_t, 12>;

constexpr std::size_t kNegotiationBytes = 26;  // of UVC 1.0's probe and commit blocks
constexpr int kSetCurrent = 0x01, kGetCurrent = 0x81, kGetMinimum = 0x82, kGetMaximum = 0x83,
              kGetResolution = 0x84, kGetLength = 0x85, kGetInfo = 0x86, kGetDefault = 0x87;

std::uint32_t read32(const UsbBytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  if (at + sizeof(value) <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}
void write32(UsbBytes& bytes, std::size_t at, std::uint32_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

bool read_all(int socket, void* data, std::size_t size) {
  auto* at = static_cast<std::uint8_t*>(data);
  while (size > 0) {
    const ssize_t count = ::read(socket, at, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool write_all(int socket, std::span<const std::uint8_t> data) {
  while (!data.empty()) {
    const ssize_t count = ::send(socket, data.data(), data.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    data = data.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

std::span<const std::uint8_t> bytes_of(const Header& header) {
  return {reinterpret_cast<const std::uint8_t*>(header.data()), sizeof(header)};
}

bool is_known_as(const std::string& serial) {
  const std::vector<CameraInformation> cameras = kernel_cameras().cameras();
  return std::any_of(cameras.begin(), cameras.end(),
                     [&](const CameraInformation& camera) { return camera.serial == serial; });
}

}  // namespace

UsbCamera::UsbCamera(const Film& film, UsbCameraDescription description, int port)
    : film_(film),
      description_(std::move(description)),
      port_(port),
      sent_us_(static_cast<std::size_t>(film.pictures())),
      probe_(kNegotiationBytes),
      commit_(kNegotiationBytes),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  for (const UsbFormat format : description_.formats) {
    std::vector<UsbBytes>& pictures = pictures_.emplace_back();
    for (int i = 0; i < film.pictures(); ++i) {
      pictures.push_back(encode_picture(film.picture(i), format));
    }
  }
  thread_ = std::thread([this] { run(); });
  plug();
}

UsbCamera::~UsbCamera() {
  unplug();
  // The kernel takes its time; whoever comes next must not find this one.
  for (int attempt = 0; attempt < 500 && is_known_as(description_.serial); ++attempt) {
    ::usleep(10'000);
  }
  perform([this] { stop_ = true; });
  thread_.join();
}

void UsbCamera::unplug() {
  perform([this] { detach(); });
}
void UsbCamera::plug() {
  perform([this] { attach(); });
}
void UsbCamera::damage_next(Damage damage) {
  perform([this, damage] { damage_ = damage; });
}
void UsbCamera::pause(bool paused) {
  paused_ = paused;
}

// Has the thread do something, and waits until it is done.
void UsbCamera::perform(const std::function<void()>& action) {
  std::unique_lock lock(mutex_);
  action_ = action;
  const std::uint64_t one = 1;
  if (::write(wake_.get(), &one, sizeof(one)) != sizeof(one)) throw std::runtime_error("eventfd");
  done_.wait(lock, [this] { return action_ == nullptr; });
}

void UsbCamera::run() {
  while (!stop_) {
    std::array<pollfd, 2> descriptors = {{{wake_.get(), POLLIN, 0}, {socket_.get(), POLLIN, 0}}};
    ::poll(descriptors.data(), descriptors.size(), timeout_ms());
    std::uint64_t wakes = 0;
    if (::read(wake_.get(), &wakes, sizeof(wakes)) == sizeof(wakes)) {
      const std::lock_guard lock(mutex_);
      if (action_) action_();
      action_ = nullptr;
      done_.notify_all();
      continue;
    }
    if (socket_ && descriptors[1].revents != 0) {
      serve_socket();
    } else {
      send_due();
    }
  }
}

void UsbCamera::attach() {
  if (socket_) return;
  // The port is free again a while after it was left.
  for (int attempt = 0; attempt < 100; ++attempt) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) break;
    UniqueFd ours(ends[0]), kernels(ends[1]);
    const int room = 1 << 23;
    ::setsockopt(ours.get(), SOL_SOCKET, SO_SNDBUFFORCE, &room, sizeof(room));
    ::fcntl(ours.get(), F_SETFD, FD_CLOEXEC);
    ::fcntl(kernels.get(), F_SETFD, FD_CLOEXEC);
    std::ofstream file("/sys/devices/platform/vhci_hcd.0/attach");
    constexpr int kDeviceId = 65538, kHighSpeed = 3;
    file << port_ << ' ' << kernels.get() << ' ' << kDeviceId << ' ' << kHighSpeed << std::flush;
    if (file) {
      socket_ = std::move(ours);
      // A camera forgets when it loses its power.
      exposure_mode_ = 8;
      exposure_priority_ = 1;
      exposure_time_ = 333;
      return;
    }
    ::usleep(20'000);
  }
  throw std::runtime_error("the kernel's vhci_hcd does not take the camera");
}

void UsbCamera::detach() {
  if (socket_) ::shutdown(socket_.get(), SHUT_RDWR);
  socket_.reset();
  transfers_.clear();
  streaming_ = false;
  current_ = nullptr;
}

void UsbCamera::serve_socket() {
  Header header{};
  if (!read_all(socket_.get(), header.data(), sizeof(header))) {
    detach();
    return;
  }
  const std::uint32_t command = ntohl(header[0]);
  if (command == kSubmit) submit(header);
  if (command == kUnlink) unlink(header);
}

void UsbCamera::submit(const Header& header) {
  const std::uint32_t sequence = ntohl(header[1]), length = ntohl(header[6]);
  const bool in = ntohl(header[3]) != 0, endpoint_zero = ntohl(header[4]) == 0;
  UsbBytes data;
  if (!in && length > 0) {
    data.resize(std::min<std::uint32_t>(length, 1 << 16));
    if (!read_all(socket_.get(), data.data(), data.size())) return;
  }
  if (!endpoint_zero) {
    transfers_.push_back({sequence, length});
    return;
  }
  std::array<std::uint8_t, 8> setup{};
  std::memcpy(setup.data(), &header[10], setup.size());
  control(sequence,
          {setup[0], setup[1], setup[2] | setup[3] << 8, setup[4] | setup[5] << 8,
           setup[6] | setup[7] << 8},
          data);
}

void UsbCamera::unlink(const Header& header) {
  const std::uint32_t unlinked = ntohl(header[5]);
  const auto found =
      std::find_if(transfers_.begin(), transfers_.end(),
                   [&](const Transfer& transfer) { return transfer.sequence == unlinked; });
  Header answer{};
  answer[0] = htonl(kUnlinkReply);
  answer[1] = header[1];
  if (found != transfers_.end()) {
    transfers_.erase(found);
    answer[5] = htonl(static_cast<std::uint32_t>(-ECONNRESET));
  }
  write_all(socket_.get(), bytes_of(answer));
}

void UsbCamera::control(std::uint32_t sequence, const Setup& setup, const UsbBytes& data) {
  constexpr int kClassRequest = 0x20, kTypeMask = 0x60, kIn = 0x80;
  std::optional<UsbBytes> answer;
  if ((setup.type & kTypeMask) == 0) {
    answer = standard_request(setup);
  } else if ((setup.type & kTypeMask) == kClassRequest && (setup.index & 0xff) == 0) {
    answer = exposure_request(setup, data);
  } else if ((setup.type & kTypeMask) == kClassRequest) {
    answer = stream_request(setup, data);
  }
  if (!answer) {
    reply(sequence, -EPIPE, {}, 0);
  } else if ((setup.type & kIn) != 0) {
    answer->resize(std::min(answer->size(), static_cast<std::size_t>(setup.length)));
    reply(sequence, 0, *answer, static_cast<std::uint32_t>(answer->size()));
  } else {
    reply(sequence, 0, {}, static_cast<std::uint32_t>(data.size()));
  }
}

std::optional<UsbBytes> UsbCamera::standard_request(const Setup& setup) {
  constexpr int kGetStatus = 0, kClearFeature = 1, kSetFeature = 3, kGetDescriptor = 6,
                kGetConfiguration = 8, kSetConfiguration = 9, kGetInterface = 10,
                kSetInterface = 11;
  switch (setup.request) {
    case kGetStatus:
      return UsbBytes{0, 0};
    case kClearFeature:  // of the endpoint: uvcvideo stops a bulk stream so
      if ((setup.index & 0xff) != 0) streaming_ = false;
      return UsbBytes{};
    case kGetConfiguration:
      return UsbBytes{1};
    case kGetInterface:
      return UsbBytes{0};
    case kSetFeature:
    case kSetConfiguration:
    case kSetInterface:
      return UsbBytes{};
    case kGetDescriptor:
      break;
    default:
      return std::nullopt;
  }
  const int type = setup.value >> 8, index = setup.value & 0xff;
  if (type == 1) return device_descriptor();
  if (type == 2) return configuration_descriptor(description_);
  if (type != 3) return std::nullopt;
  if (index == 0) return UsbBytes{4, 3, 9, 4};  // English
  return string_descriptor(index == 1   ? "Roundel"
                           : index == 2 ? description_.name
                                        : description_.serial);
}

// The camera terminal: exposure mode, priority and time, as a webcam has them. While the exposure
// is automatic, its time can't be set.
std::optional<UsbBytes> UsbCamera::exposure_request(const Setup& setup, const UsbBytes& data) {
  constexpr int kPower = 0, kMode = 2, kTime = 4;  // 3: priority
  const int entity = setup.index >> 8, selector = setup.value >> 8;
  if (entity == kPower)
    return setup.request == kGetCurrent ? std::optional(UsbBytes{0}) : std::nullopt;
  const auto byte = [](int value) { return UsbBytes{static_cast<std::uint8_t>(value)}; };
  const auto word = [](std::int64_t value) {
    UsbBytes bytes(4);
    write32(bytes, 0, static_cast<std::uint32_t>(value));
    return bytes;
  };
  if (selector < kMode || selector > kTime || entity != kUsbCameraTerminal) return std::nullopt;
  if (setup.request == kGetInfo) return byte(3);  // can be read and set
  if (setup.request == kGetLength)
    return UsbBytes{static_cast<std::uint8_t>(selector == kTime ? 4 : 1), 0};
  if (selector == kTime) {
    constexpr int kManual = 1;
    switch (setup.request) {
      case kSetCurrent:
        if (exposure_mode_ != kManual) return std::nullopt;
        exposure_time_ = read32(data, 0);
        return UsbBytes{};
      case kGetCurrent:
        return word(exposure_time_);
      case kGetMinimum:
      case kGetResolution:
        return word(1);
      case kGetMaximum:
        return word(5000);
      default:
        return word(333);
    }
  }
  std::atomic<int>& value = selector == kMode ? exposure_mode_ : exposure_priority_;
  switch (setup.request) {
    case kSetCurrent:
      if (data.empty()) return std::nullopt;
      value = data[0];
      return UsbBytes{};
    case kGetCurrent:
      return byte(value);
    case kGetResolution:  // of the mode: those that there are, manual (1) and aperture priority (8)
      return byte(selector == kMode ? 9 : 1);
    case kGetDefault:
      return byte(selector == kMode ? 8 : 1);
    case kGetMinimum:
      return byte(selector == kMode ? 1 : 0);
    default:
      return byte(selector == kMode ? 8 : 1);
  }
}

// UVC's negotiation: the host proposes a block (format, frame, interval), the camera corrects it.
std::optional<UsbBytes> UsbCamera::stream_request(const Setup& setup, const UsbBytes& data) {
  const int selector = setup.value >> 8;  // 1: probe, 2: commit
  if (selector != 1 && selector != 2) return std::nullopt;
  UsbBytes& block = selector == 1 ? probe_ : commit_;
  UsbBytes answer = probe_;
  switch (setup.request) {
    case kSetCurrent:
      std::copy_n(data.begin(), std::min(data.size(), block.size()), block.begin());
      negotiate(block);
      if (selector == 2) {
        streaming_ = true;
        current_ = nullptr;
        due_us_ = now().mono_us;
      }
      return UsbBytes{};
    case kGetCurrent:
      return block;
    case kGetInfo:
      return UsbBytes{3};
    case kGetLength:
      return UsbBytes{kNegotiationBytes, 0};
    case kGetMinimum:
    case kGetMaximum:
    case kGetResolution:
      negotiate(answer);
      write32(answer, 4,
              interval_100ns(setup.request == kGetMinimum ? description_.frame_rates.front()
                                                          : description_.frame_rates.back()));
      return answer;
    case kGetDefault:
      answer = UsbBytes(kNegotiationBytes);
      negotiate(answer);
      return answer;
    default:
      return std::nullopt;
  }
}

void UsbCamera::negotiate(UsbBytes& block) const {
  const auto formats = static_cast<int>(description_.formats.size());
  block[2] = static_cast<std::uint8_t>(std::clamp<int>(block[2], 1, formats));
  block[3] = 1;
  const std::uint32_t wanted = read32(block, 4);
  std::uint32_t nearest = interval_100ns(description_.frame_rates.front());
  for (const int rate : description_.frame_rates) {
    const std::uint32_t interval = interval_100ns(rate);
    const auto distance = [&](std::uint32_t other) {
      return std::abs(std::int64_t{other} - std::int64_t{wanted});
    };
    if (wanted != 0 && distance(interval) < distance(nearest)) nearest = interval;
  }
  write32(block, 4, nearest);
  write32(block, 18, description_.frame_bytes(description_.formats[block[2] - 1U]));
  write32(block, 22, kUsbPayload);
}

void UsbCamera::reply(std::uint32_t sequence, int status, std::span<const std::uint8_t> data,
                      std::uint32_t actual) {
  Header header{};
  header[0] = htonl(kSubmitReply);
  header[1] = htonl(sequence);
  header[5] = htonl(static_cast<std::uint32_t>(status));
  header[6] = htonl(actual);
  if (!write_all(socket_.get(), bytes_of(header)) || !write_all(socket_.get(), data)) detach();
}

int UsbCamera::timeout_ms() const {
  constexpr int kIdleMs = 100;
  if (!socket_ || !streaming_ || paused_) return kIdleMs;
  if (current_ != nullptr) return transfers_.empty() ? kIdleMs : 0;
  const std::int64_t left_us = due_us_ - now().mono_us;
  return static_cast<int>(std::clamp<std::int64_t>((left_us + 999) / 1000, 0, kIdleMs));
}

// Frames come at their rate; one for which the host has no room is lost, as in a real camera.
void UsbCamera::send_due() {
  if (!socket_ || !streaming_) return;
  if (current_ == nullptr) {
    const std::int64_t current_us = now().mono_us;
    if (current_us < due_us_) return;
    due_us_ = std::max(due_us_ + read32(commit_, 4) / 10, current_us);
    const int picture = film_.shown(shown_++);
    if (paused_ || transfers_.empty()) return;
    current_ = &pictures_[commit_[2] - 1U][static_cast<std::size_t>(picture)];
    if (damage_ == Damage::kCorrupt) {
      corrupt_ = *current_;
      std::fill(corrupt_.begin() + static_cast<std::ptrdiff_t>(corrupt_.size() / 2), corrupt_.end(),
                std::uint8_t{0});
      current_ = &corrupt_;
      damage_ = Damage::kNone;
    }
    sent_bytes_ = 0;
    end_bytes_ = damage_ == Damage::kShort ? current_->size() / 2 : current_->size();
    sent_us_[static_cast<std::size_t>(picture)] = current_us;
  }
  if (!transfers_.empty()) send_payload();
}

void UsbCamera::send_payload() {
  const Transfer transfer = transfers_.front();
  transfers_.pop_front();
  if (damage_ == Damage::kStall) {
    damage_ = Damage::kNone;
    reply(transfer.sequence, -EPIPE, {}, 0);
    return;
  }
  constexpr int kEndOfFrame = 2, kErrorBit = 0x40, kEndOfHeader = 0x80;
  constexpr std::size_t kHeaderBytes = 2;
  const std::size_t bytes =
      std::min<std::size_t>(transfer.length - kHeaderBytes, end_bytes_ - sent_bytes_);
  const bool last = sent_bytes_ + bytes >= end_bytes_;
  const int flags = kEndOfHeader | (frame_id_ ? 1 : 0) | (last ? kEndOfFrame : 0) |
                    (damage_ == Damage::kErrorBit ? kErrorBit : 0);
  payload_.resize(kHeaderBytes + bytes);
  payload_[0] = kHeaderBytes;
  payload_[1] = static_cast<std::uint8_t>(flags);
  std::copy_n(current_->begin() + static_cast<std::ptrdiff_t>(sent_bytes_), bytes,
              payload_.begin() + kHeaderBytes);
  sent_bytes_ += bytes;
  if (last) {
    current_ = nullptr;
    frame_id_ = !frame_id_;
    damage_ = Damage::kNone;
    ++frames_sent_;
  }
  reply(transfer.sequence, 0, payload_, static_cast<std::uint32_t>(payload_.size()));
}

}  // namespace roundel
