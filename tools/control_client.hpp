#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace roundel {

inline constexpr const char* kDefaultControlSocket = "/run/roundel/control.sock";

// Adds --socket.
CLI::Option* add_socket_option(CLI::App& command, std::string& socket);

// A request that roundeld refused, or could not be asked.
class ControlError : public std::runtime_error {
 public:
  ControlError(long status, const std::string& what) : std::runtime_error(what), status_(status) {}
  long status() const { return status_; }  // of HTTP; 0: roundeld can't be reached

 private:
  long status_;
};

// Talks to a running roundeld over its control socket. All calls throw ControlError (or
// std::runtime_error, if the answer makes no sense) with a sentence for the user.
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
