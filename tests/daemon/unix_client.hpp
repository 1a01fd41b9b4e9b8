#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <string>
#include <string_view>

#include "calibration/unique_fd.hpp"

namespace roundel {

// A client of a Unix socket that may behave as badly as it likes.
class UnixClient {
 public:
  // Tries until somebody listens.
  explicit UnixClient(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    do {
      socket_ = UniqueFd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
      connected_ = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address),
                             sizeof address) == 0;
      if (!connected_) ::poll(nullptr, 0, 1);
    } while (!connected_ && std::chrono::steady_clock::now() < deadline);
  }

  bool connected() const { return connected_; }
  int descriptor() const { return socket_.get(); }

  // How much of it was taken before the server closed.
  std::size_t send(std::string_view text) const {
    std::size_t sent = 0;
    while (sent < text.size()) {
      const ssize_t n = ::send(socket_.get(), text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) break;
      sent += static_cast<std::size_t>(n);
    }
    return sent;
  }

  // Everything up to the text, or to the server's end of the connection, or to the time limit.
  std::string read_until(std::string_view text, std::chrono::milliseconds limit) const {
    std::string got;
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (text.empty() || got.find(text) == std::string::npos) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          deadline - std::chrono::steady_clock::now());
      pollfd descriptor = {socket_.get(), POLLIN, 0};
      if (left.count() <= 0 || ::poll(&descriptor, 1, static_cast<int>(left.count())) <= 0) break;
      char buffer[65536];
      const ssize_t n = ::recv(socket_.get(), buffer, sizeof buffer, 0);
      if (n <= 0) break;
      got.append(buffer, static_cast<std::size_t>(n));
    }
    return got;
  }

  // A whole exchange; the answer with its head. Empty: there was none.
  std::string ask(const std::string& method, const std::string& path,
                  const std::string& body = {}) const {
    send(method + " " + path + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body);
    return read_until("", std::chrono::seconds(30));
  }

 private:
  UniqueFd socket_;
  bool connected_ = false;
};

inline std::string ask(const std::string& path, const std::string& method,
                       const std::string& target, const std::string& body = {}) {
  return UnixClient(path).ask(method, target, body);
}

}  // namespace roundel
