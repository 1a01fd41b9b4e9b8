#include <memory>
#include <string>

#include "tools/commands.hpp"
#include "tools/control_client.hpp"

namespace roundel {

void add_reload(CLI::App& app) {
  auto* command = app.add_subcommand(
      "reload",
      "Make a running roundeld read its configuration again; a wrong one changes nothing");
  const auto socket = std::make_shared<std::string>(kDefaultControlSocket);
  add_socket_option(*command, *socket);
  command->callback([socket] { ControlClient(*socket).request("POST", "/v1/reload"); });
}

}  // namespace roundel
