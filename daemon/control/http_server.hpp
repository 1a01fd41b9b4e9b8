#pragma once

#include <chrono>
#include <memory>

#include "calibration/unique_fd.hpp"
#include "daemon/control/http_message.hpp"

namespace roundel {

// What a client may cost.
struct HttpLimits {
  unsigned connections = 512;
  unsigned streams = 16;
  std::size_t body = std::size_t{64} << 10;    // bytes of a request
  std::size_t memory = std::size_t{24} << 10;  // bytes of a connection: headers and buffers
  // Bytes of answers that clients have not taken yet, of all together; larger pictures are refused
  // meanwhile. The only one may have any size.
  std::size_t untaken = std::size_t{64} << 20;
  std::chrono::seconds idle{10};   // without a byte either way
  std::chrono::seconds whole{30};  // from the connection's begin to its end; event
                                   // streams may stay
};

// HTTP/1.1 on a listening socket, on one thread of its own that handles all connections.
class HttpServer {
 public:
  // Throws std::runtime_error if the server can't be started.
  HttpServer(UniqueFd listening, HttpHandler handler, const HttpLimits& limits);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  // To be called when streams may have something to read, and about once a second.
  void wake_streams();
  void end_overdue();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roundel
