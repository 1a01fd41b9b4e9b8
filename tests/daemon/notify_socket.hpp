#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "calibration/unique_fd.hpp"
#include "tests/temporary_directory.hpp"

namespace roundel {

// systemd's end of NOTIFY_SOCKET.
class NotifySocket {
 public:
  NotifySocket() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path().copy(address.sun_path, sizeof address.sun_path - 1);
    bound_ =
        ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }

  bool bound() const { return bound_; }
  std::string path() const { return folder_.file("notify"); }

  // The next message; nothing if none comes in time.
  std::optional<std::string> receive(std::chrono::milliseconds timeout) {
    pollfd descriptor = {socket_.get(), POLLIN, 0};
    if (::poll(&descriptor, 1, static_cast<int>(timeout.count())) != 1) return std::nullopt;
    std::array<char, 4096> message;
    const ssize_t length = ::recv(socket_.get(), message.data(), message.size(), 0);
    if (length < 0) return std::nullopt;
    return std::string(message.data(), static_cast<std::size_t>(length));
  }

  // All messages up to and including the one that begins with the text; empty if it does not come.
  std::vector<std::string> receive_until(const std::string& begin,
                                         std::chrono::milliseconds timeout) {
    std::vector<std::string> messages;
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    for (;;) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          deadline - std::chrono::steady_clock::now());
      if (left.count() <= 0) return {};
      std::optional<std::string> message = receive(left);
      if (!message) return {};
      messages.push_back(std::move(*message));
      if (messages.back().starts_with(begin)) return messages;
    }
  }

 private:
  TemporaryDirectory folder_;
  UniqueFd socket_;
  bool bound_ = false;
};

}  // namespace roundel
