#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

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

  // By POST, a body without end: `take` is given it piece by piece, until it returns false or roundeld ends;
  // what it throws comes out here. `go_on` is asked besides, at least once a second.
  void stream(const std::string& path, const std::function<bool(std::string_view)>& take,
              const std::function<bool()>& go_on) const;

 private:
  std::string socket_;
};

}  // namespace roundel
