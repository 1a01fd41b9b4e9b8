#include "tools/live_views.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <span>
#include <stdexcept>

#include "daemon/image_codecs.hpp"
#include "daemon/signal_descriptor.hpp"
#include "tools/collection_progress.hpp"
#include "tools/control_client.hpp"

namespace roundel {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRetryMs = 500;
constexpr int kNiceness = 10;  // roundeld comes first

// "P5\n1920 1080\n255\n" and the pixels, as roundeld sends them.
void read_picture(const std::string& file, GreyImage& frame) {
  try {
    if (!file.starts_with("P5")) throw std::runtime_error("is no picture");
    decode_pgm({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, frame);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("what roundeld sent {}", error.what()));
  }
}

// The next frame; false, with the reason, if it has to be asked again later. What was collected is
// worth waiting for a roundeld that starts again.
bool fetch(const ControlClient& client, bool something_to_lose, GreyImage& frame,
           std::string& trouble) {
  constexpr long kUnavailable = 503;
  try {
    read_picture(client.request("GET", "/v1/frame.pgm"), frame);
    return true;
  } catch (const ControlError& error) {
    const bool unreachable = error.status() == 0;
    if (error.status() != kUnavailable && !(unreachable && something_to_lose)) throw;
    trouble = error.what();
    return false;
  }
}

void check_size(const GreyImage& frame, const ViewCollector& collector) {
  if (frame.width == collector.width() && frame.height == collector.height()) return;
  throw std::runtime_error(
      fmt::format("the camera's pictures are {}x{} now, they were {}x{} before; a calibration "
                  "holds for one resolution",
                  frame.width, frame.height, collector.width(), collector.height()));
}

// Signals end the collection, and after it, the program again.
class SignalsForNow {
 public:
  SignalsForNow() { ::pthread_sigmask(SIG_BLOCK, nullptr, &before_); }
  ~SignalsForNow() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsForNow(const SignalsForNow&) = delete;
  SignalsForNow& operator=(const SignalsForNow&) = delete;

 private:
  sigset_t before_{};
};

// Waits; true if the time is over or a signal asks for the end.
bool ends(SignalDescriptor& signals, Clock::time_point deadline, int wait_ms) {
  pollfd descriptor = {signals.descriptor(), POLLIN, 0};
  ::poll(&descriptor, 1, wait_ms);
  return signals.take() != SignalEvent::kNone || Clock::now() >= deadline;
}

}  // namespace

ViewCollector collect_live(const Board& board, const LiveOptions& options) {
  ::setpriority(PRIO_PROCESS, 0, kNiceness);
  const ControlClient client(options.socket);
  const SignalsForNow restored;
  SignalDescriptor signals;
  const auto start = Clock::now();
  const auto deadline = start + std::chrono::duration_cast<Clock::duration>(
                                    std::chrono::duration<double>(options.time_limit_s));
  std::optional<CollectionProgress> progress;
  std::optional<ViewCollector> collector;
  GreyImage frame;
  std::string trouble = "no frame comes from the camera";
  for (bool ended = false; !ended;) {
    const bool got = fetch(client, collector.has_value(), frame, trouble);
    if (!progress && !options.quiet) progress.emplace();
    if (got) {
      if (!collector) collector.emplace(board, frame.width, frame.height);
      check_size(frame, *collector);
      const std::chrono::duration<double> passed = Clock::now() - start;
      const auto outcome =
          collector->offer(frame.view(), fmt::format("at {:.1f} s", passed.count()));
      if (progress) progress->show(outcome, *collector);
      if (outcome == ViewCollector::Outcome::kTaken && collector->advice().empty()) break;
      if (outcome == ViewCollector::Outcome::kFull) break;
    } else if (progress) {
      progress->show_trouble(trouble);
    }
    ended = ends(signals, deadline, got ? 0 : kRetryMs);
  }
  if (!collector) throw std::runtime_error(trouble);
  return std::move(*collector);
}

}  // namespace roundel
