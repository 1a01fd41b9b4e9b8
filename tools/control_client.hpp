#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

namespace roundel {

inline constexpr const char* kDefaultControlSocket = "/run/roundel/control.sock";

// Adds --socket.
void add_socket_option(CLI::App& command, std::string& socket);

// Talks to a running roundeld over its control socket. All calls throw std::runtime_error with a
// sentence for the user: roundeld can't be reached, or what it answered.
class ControlClient {
 public:
  explicit ControlClient(std::string socket) : socket_(std::move(socket)) {}

  // The body of the answer.
  std::string request(const std::string& method, const std::string& path,
                      const std::string& body = {}) const;

  nlohmann::ordered_json get(const std::string& path) const;
  nlohmann::ordered_json send(const std::string& method, const std::string& path,
                              const nlohmann::ordered_json& body) const;

 private:
  std::string socket_;
};

}  // namespace roundel
