#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include "daemon/json_frame.hpp"
#include "daemon/signal_descriptor.hpp"
#include "tools/commands.hpp"
#include "tools/pose_table.hpp"
#include "tools/reception_summary.hpp"
#include "tools/standard_output.hpp"
#include "transport/lcm_url.hpp"
#include "transport/subscriber.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

struct ListenOptions {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string channel = "ROUNDEL";
  std::string interface_name;
  bool json = false;
  bool summary = false;  // nothing else
  double seconds = std::numeric_limits<double>::infinity();
};

std::int64_t steady_us() {
  return now().mono_us;
}

// Values come in single precision: 0.1 shall be printed as 0.1, not as 0.10000000149.
double shortest(double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), static_cast<float>(value)).ptr;
  double result = value;
  std::from_chars(text.data(), end, result);
  return result;
}

void shorten_numbers(Json& json) {
  if (json.is_number_float()) json = shortest(json.get<double>());
  if (json.is_structured()) {
    for (Json& element : json) shorten_numbers(element);
  }
}

Json received_json(const ReceivedFrame& frame, const ReceptionCounts& counts,
                   std::int64_t received_utime) {
  const header_t& header = frame.header;
  std::vector<Marker> markers;
  std::vector<ArenaPose> arena;
  for (const marker_t& marker : frame.markers) {
    markers.push_back(from_message(marker));
    arena.push_back(arena_from_message(marker));
  }
  Json json = frame_json({frame.camera, header.frame, header.capture_utime, header.tracking_us},
                         markers, arena);
  shorten_numbers(json);
  json["session"] = header.session;
  json["publish_utime"] = header.publish_utime;
  json["receive_utime"] = received_utime;
  json["dropped"] = header.dropped;
  json["lost"] = counts.lost;
  json["latency_us"] = received_utime - header.capture_utime;
  json["simulated"] = header.simulated != 0;
  return json;
}

// Where the table is drawn: over itself on a terminal, one after another elsewhere.
class Screen {
 public:
  bool is_terminal() const { return terminal_; }
  std::int64_t period_us() const { return terminal_ ? 250'000 : 1'000'000; }

  std::size_t max_rows() const {
    constexpr std::size_t kOtherLines = 4;
    winsize size{};
    if (!terminal_ || ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0) {
      return std::numeric_limits<std::size_t>::max();
    }
    return std::max<std::size_t>(1, std::max<std::size_t>(size.ws_row, kOtherLines) - kOtherLines);
  }

  void draw(const std::string& text) {
    if (terminal_) {
      if (lines_ > 0) fmt::print("\x1b[{}F", lines_);
      fmt::print("\x1b[J");
      lines_ = std::count(text.begin(), text.end(), '\n');
    }
    fmt::print("{}{}", text, terminal_ ? "" : "\n");
    std::fflush(stdout);
  }

 private:
  bool terminal_ = ::isatty(STDOUT_FILENO) == 1;
  std::ptrdiff_t lines_ = 0;  // drawn, above the cursor
};

std::unique_ptr<Subscriber> subscribe(const ListenOptions& options) {
  try {
    return std::make_unique<Subscriber>(options.url, options.channel, options.interface_name);
  } catch (const LcmUrlError& error) {
    throw UsageError(fmt::format("--url: {}", error.what()));
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--channel: {}", error.what()));
  }
}

// Sleeps until a message or a signal comes, or the instant. False if a signal asked to stop.
bool wait(SignalDescriptor& signals, const Subscriber& subscriber, std::int64_t until_us) {
  std::array<pollfd, 2> descriptors = {
      {{signals.descriptor(), POLLIN, 0}, {subscriber.descriptor(), POLLIN, 0}}};
  const std::int64_t left_ms = std::clamp<std::int64_t>((until_us - steady_us() + 999) / 1000, 0,
                                                        std::numeric_limits<int>::max());
  ::poll(descriptors.data(), descriptors.size(), static_cast<int>(left_ms));
  return signals.take() == SignalEvent::kNone;
}

void require_poses(const ListenOptions& options, std::int64_t frames, std::int64_t markers,
                   std::int64_t poses) {
  if (poses > 0) return;
  if (frames == 0) {
    throw std::runtime_error(
        fmt::format("no frame arrived on {}_FRAME at {}; is roundeld running, with this URL and "
                    "channel, in this network?",
                    options.channel, options.url));
  }
  throw std::runtime_error(fmt::format(
      "{} frames arrived, but no pose: {}", frames,
      markers == 0 ? "no marker was seen" : "markers were seen by a camera without calibration"));
}

void listen(const ListenOptions& options) {
  SignalDescriptor signals;
  const std::unique_ptr<Subscriber> subscriber = subscribe(options);
  PoseTable table;
  ReceptionSummary summary;
  Screen screen;
  std::int64_t markers = 0, poses = 0;
  const bool shows_table = !options.json && !options.summary;
  const std::int64_t start_us = steady_us();
  const bool endless = options.seconds == std::numeric_limits<double>::infinity();
  const std::int64_t end_us = endless ? std::numeric_limits<std::int64_t>::max()
                                      : start_us + static_cast<std::int64_t>(options.seconds * 1e6);
  std::int64_t draw_us = start_us + screen.period_us();
  while (steady_us() < end_us) {
    if (!wait(signals, *subscriber, shows_table ? std::min(end_us, draw_us) : end_us)) break;
    while (const ReceivedFrame* frame = subscriber->next_frame(std::chrono::milliseconds(0))) {
      for (const marker_t& marker : frame->markers) poses += marker.has_pose != 0 ? 1 : 0;
      markers += static_cast<std::int64_t>(frame->markers.size());
      const std::int64_t received_utime = subscriber->received_utime();
      summary.add(*frame, received_utime, steady_us());
      if (options.summary) continue;
      if (options.json) {
        print(json_line(received_json(*frame, subscriber->counts(), received_utime)));
      } else {
        table.add(*frame, subscriber->counts(), received_utime, steady_us());
      }
    }
    if (shows_table && steady_us() >= draw_us) {
      screen.draw(table.text(screen.max_rows(), steady_us()));
      draw_us = steady_us() + screen.period_us();
    }
  }
  if (options.summary && options.json) {
    print(json_line(summary.json(subscriber->counts())));
  } else if (!options.json) {
    print(summary.text(subscriber->counts()));
  }
  require_poses(options, subscriber->counts().frames, markers, poses);
}

}  // namespace

void add_listen(CLI::App& app) {
  auto* command = app.add_subcommand("listen", "Print poses arriving over LCM");
  const auto options = std::make_shared<ListenOptions>();
  command->add_option("--url", options->url, "LCM URL that roundeld sends to")
      ->type_name("URL")
      ->capture_default_str();
  command->add_option("--channel", options->channel, "Prefix of the channels")
      ->type_name("PREFIX")
      ->capture_default_str();
  command
      ->add_option("--interface", options->interface_name,
                   "Network interface to listen at (default: as the routes say)")
      ->type_name("NAME");
  command->add_flag("--json", options->json, "One JSON object a frame");
  command->add_flag("--summary", options->summary,
                    "Only say at the end: rate, losses, latency (with --json, one object)");
  command->add_option("--seconds", options->seconds, "End after so long (default: at Ctrl-C)")
      ->check(CLI::Range(0.001, 1e9))
      ->type_name("N");
  command->footer("Ends with status 1 if no pose arrived.");
  command->callback([options] { listen(*options); });
}

}  // namespace roundel
