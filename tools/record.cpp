#include <fmt/chrono.h>
#include <fmt/format.h>

#include <csignal>
#include <ctime>
#include <limits>
#include <memory>

#include "daemon/signal_descriptor.hpp"
#include "tools/commands.hpp"
#include "tools/control_client.hpp"
#include "tools/recording_run.hpp"

namespace roundel {
namespace {

struct RecordOptions {
  std::string socket = kDefaultControlSocket;
  std::string output;  // empty: named by the time
  RecordingLimits limits;
};

void record(const RecordOptions& options) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on a file's size is an error like a full disk
  SignalDescriptor signals;
  const std::string path = options.output.empty() ? fmt::format("recording-{:%Y%m%d-%H%M%S}",
                                                                fmt::localtime(std::time(nullptr)))
                                                  : options.output;
  const std::string outcome = run_recording(ControlClient(options.socket), path, options.limits,
                                            [&] { return signals.take() == SignalEvent::kNone; });
  fmt::print(stderr, "{}", outcome);
}

}  // namespace

void add_record(CLI::App& app) {
  auto* command = app.add_subcommand(
      "record", "Record the frames of a running roundeld, without loss, and their poses");
  const auto options = std::make_shared<RecordOptions>();
  RecordingLimits& limits = options->limits;
  add_socket_option(*command, options->socket);
  command->add_option("-o,--output", options->output, "Folder to make (default: recording-TIME)")
      ->type_name("FOLDER");
  command->add_option("--seconds", limits.seconds, "End after so long (default: at Ctrl-C)")
      ->check(CLI::Range(0.001, 1e9))
      ->type_name("N");
  command->add_option("--frames", limits.frames, "End after so many frames")
      ->check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()))
      ->type_name("N");
  command->add_flag("--keep-tracks", limits.keep_tracks,
                    "Don't restart tracking with the first frame: robots notice nothing, but the "
                    "poses of a replay may differ at first");
  command->callback([options] { record(*options); });
}

}  // namespace roundel
