#include "tools/collection_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "calibration/view_advice.hpp"

namespace roundel {

CollectionProgress::CollectionProgress() : terminal_(::isatty(STDERR_FILENO) == 1) {
  say("Show the board to the camera, hold it still, show it elsewhere; Ctrl-C ends it early.");
}

CollectionProgress::~CollectionProgress() {
  if (flashing_) std::fputs("\r\x1b[K", stderr);
}

void CollectionProgress::say(const std::string& line) {
  fmt::print(stderr, "{}{}\n", flashing_ ? "\r\x1b[K" : "", line);
  flashing_ = false;
  last_.clear();
}

void CollectionProgress::flash(const std::string& line) {
  if (!terminal_ || line == last_) return;
  constexpr std::size_t kColumns = 79;
  fmt::print(stderr, "\r\x1b[K{}", line.substr(0, kColumns));
  std::fflush(stderr);
  flashing_ = true;
  last_ = line;
}

void CollectionProgress::show(ViewCollector::Outcome outcome, const ViewCollector& collector) {
  const std::size_t count = collector.views().size();
  if (outcome != ViewCollector::Outcome::kTaken) {
    const std::string what =
        outcome == ViewCollector::Outcome::kReplaced ? "better than before" : describe(outcome);
    flash(fmt::format("{} views, {} markers: {}", count, collector.last().markers, what));
    return;
  }
  say(fmt::format("{}view {}: {} markers, edges {:.1f} px wide", terminal_ ? "\a" : "", count,
                  collector.last().view.points.size(), collector.last().edge_width_px));
  std::vector<std::string> advice = collector.advice();
  if (advice == told_) return;
  for (const std::string& line : advice) say("    " + line);
  told_ = std::move(advice);
}

void CollectionProgress::show_trouble(const std::string& what) {
  if (terminal_) {
    flash(what);
  } else if (what != last_) {
    say(what);
    last_ = what;
  }
}

}  // namespace roundel
