#pragma once

#include <string>

#include "calibration/unique_fd.hpp"
#include "config/web_address.hpp"

namespace roundel {

// Where browsers get to roundeld: a listening TCP socket.
struct WebSocket {
  UniqueFd descriptor;
  std::string url;  // with the port that it really has
};

// Throws std::runtime_error that names the address.
WebSocket listen_for_web(const WebAddress& address);

}  // namespace roundel
