#include <fmt/format.h>

#include <memory>
#include <string>

#include "calibration/atomic_file.hpp"
#include "tools/commands.hpp"
#include "tools/control_client.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

struct SnapshotOptions {
  std::string socket = kDefaultControlSocket;
  std::string output = "snapshot.jpg";
  bool plain = false;
};

void snapshot(const SnapshotOptions& options) {
  const bool png = options.output.ends_with(".png");
  const bool standard_output = options.output == "-";
  if (!png && !standard_output && !options.output.ends_with(".jpg") &&
      !options.output.ends_with(".jpeg")) {
    throw UsageError(
        fmt::format("{} is no picture's name: use FILE.jpg, FILE.png or - (JPEG)", options.output));
  }
  const std::string picture = ControlClient(options.socket)
                                  .request("GET", fmt::format("/v1/frame.{}{}", png ? "png" : "jpg",
                                                              options.plain ? "?overlay=0" : ""));
  if (standard_output) {
    print(picture);
  } else {
    write_file_atomically(options.output, picture);
  }
}

}  // namespace

void add_snapshot(CLI::App& app) {
  auto* command = app.add_subcommand(
      "snapshot",
      "The picture that roundeld sees, with markers, ids, axes, the arena's grid and corners");
  const auto options = std::make_shared<SnapshotOptions>();
  add_socket_option(*command, options->socket);
  command->add_option("-o,--output", options->output, "FILE.jpg, FILE.png, or - for JPEG")
      ->type_name("PATH")
      ->capture_default_str();
  command->add_flag("--plain", options->plain, "Nothing drawn in");
  command->callback([options] { snapshot(*options); });
}

}  // namespace roundel
