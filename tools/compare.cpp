#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "daemon/json_frame.hpp"
#include "tools/commands.hpp"
#include "tools/comparison_output.hpp"
#include "tools/json_lines.hpp"
#include "tools/json_truth.hpp"
#include "tools/standard_output.hpp"
#include "tools/track_statistics.hpp"

namespace roundel {
namespace {

struct CompareOptions {
  std::string truth_file, reported_file;
  double within_px = TrackStatistics::kWithinPx;
  bool json = false;
  std::optional<double> min_found, min_complete;  // percent
  std::optional<std::int64_t> max_wrong, max_swaps, max_false;
};

// The frames of a file of JSON Lines, by rising number. Errors name file and line.
template <typename Frame>
class FrameLines {
 public:
  FrameLines(const std::string& path, Frame (*parse)(const nlohmann::ordered_json&))
      : lines_(path), parse_(parse) {
    if (!next()) {
      throw std::runtime_error(fmt::format("{} is empty", lines_.name()));
    }
  }

  // The frame read last; nothing behind the end.
  const std::optional<Frame>& frame() const { return frame_; }

  bool next() {
    const auto json = lines_.next();
    if (!json) {
      frame_.reset();
      return false;
    }
    std::optional<Frame> read;
    try {
      read = parse_(*json);
    } catch (const std::runtime_error& error) {
      lines_.fail(error.what());
    }
    if (frame_ && read->frame <= frame_->frame) {
      fail(fmt::format("frame {} follows frame {}", read->frame, frame_->frame));
    }
    frame_ = std::move(read);
    return true;
  }

  [[noreturn]] void fail(const std::string& what) const { lines_.fail(what); }
  const std::string& name() const { return lines_.name(); }

 private:
  JsonLines lines_;
  Frame (*parse_)(const nlohmann::ordered_json&);
  std::optional<Frame> frame_;
};

TrackStatistics statistics_of(const CompareOptions& options) {
  TrackStatistics statistics(options.within_px);
  // The truth second: in a pipe it is being written, but its lines come before their frames.
  FrameLines<ReportedFrame> reported(options.reported_file, frame_from_json);
  FrameLines<FrameTruth> truth(options.truth_file, truth_from_json);
  for (; truth.frame(); truth.next()) {
    try {
      if (!reported.frame() || truth.frame()->frame < reported.frame()->frame) {
        statistics.add_unanswered(*truth.frame());
        continue;
      }
      if (truth.frame()->frame > reported.frame()->frame) {
        break;
      }
      statistics.add(*truth.frame(), reported.frame()->markers);
    } catch (const std::invalid_argument& error) {
      truth.fail(error.what());
    }
    reported.next();
  }
  if (reported.frame()) {
    reported.fail(fmt::format("frame {} is not in {}", reported.frame()->frame, truth.name()));
  }
  return statistics;
}

// What falls short of the thresholds, as a sentence; empty if nothing does.
class Verdict {
 public:
  void at_least(const std::optional<double>& percent, std::int64_t part, std::int64_t whole,
                const std::string& what) {
    if (!percent) {
      return;
    }
    if (whole == 0) {
      add(fmt::format("{}: there are none", what));
    } else if (100 * static_cast<double>(part) < *percent * static_cast<double>(whole)) {
      add(fmt::format("{}: {} of {} ({:.3f} %), less than {} %", what, part, whole,
                      100 * static_cast<double>(part) / static_cast<double>(whole), *percent));
    }
  }

  void at_most(const std::optional<std::int64_t>& limit, std::int64_t count,
               const std::string& what) {
    if (limit && count > *limit) {
      add(fmt::format("{}: {}, more than {}", what, count, *limit));
    }
  }

  const std::string& sentence() const { return sentence_; }

 private:
  void add(const std::string& fault) { sentence_ += (sentence_.empty() ? "" : "; ") + fault; }
  std::string sentence_;
};

void compare(const CompareOptions& options) {
  if (options.truth_file == "-" && options.reported_file == "-") {
    throw UsageError("truth and report can't both come on standard input");
  }
  const TrackStatistics statistics = statistics_of(options);
  print(options.json ? json_line(comparison_json(statistics)) : comparison_text(statistics));

  if (options.max_swaps && !statistics.has_tracks()) {
    throw std::runtime_error(
        fmt::format("{} has no track numbers to find swaps by; it should come from roundel track",
                    options.reported_file));
  }
  Verdict verdict;
  verdict.at_least(options.min_found, statistics.found(), statistics.visible(),
                   "visible markers found");
  verdict.at_least(options.min_complete, statistics.complete_frames(), statistics.frames(),
                   "frames with all visible markers");
  verdict.at_most(
      options.max_wrong, statistics.late_wrong_ids(),
      fmt::format("wrong ids after the first {} frames of a track", TrackStatistics::kFirstFrames));
  verdict.at_most(options.max_swaps, statistics.swaps(), "id swaps");
  verdict.at_most(options.max_false, statistics.not_in_truth(), "markers not in the truth");
  if (!verdict.sentence().empty()) {
    throw std::runtime_error(verdict.sentence());
  }
}

void add_thresholds(CLI::App& command, CompareOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help, const CLI::Validator& range,
                       const char* unit) {
    command.add_option(name, value, help)->check(range)->type_name(unit)->group("Thresholds");
  };
  const CLI::Range percent(0.0, 100.0);
  const CLI::Range count(std::int64_t{0}, std::int64_t{1'000'000'000'000});
  add("--min-found", options.min_found, "Of the visible markers", percent, "PERCENT");
  add("--min-complete", options.min_complete, "Of the frames: those with all visible markers",
      percent, "PERCENT");
  add("--max-wrong", options.max_wrong, "Wrong ids after the first three frames of a track", count,
      "N");
  add("--max-swaps", options.max_swaps, "Id swaps", count, "N");
  add("--max-false", options.max_false, "Markers that are not in the truth", count, "N");
}

}  // namespace

void add_compare(CLI::App& app) {
  auto* command = app.add_subcommand(
      "compare", "Hold what track or detect reported against the truth of the simulated arena");
  auto options = std::make_shared<CompareOptions>();
  command
      ->add_option("FILE", options->reported_file,
                   "What track --json or detect --json printed; - for standard input")
      ->required();
  command->add_option("--truth", options->truth_file, "What simulate --truth wrote")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--within", options->within_px,
                   "A reported marker further away from the true one is another")
      ->check(CLI::Range(0.01, 1000.0))
      ->type_name("PIXELS")
      ->capture_default_str();
  command->add_flag("--json", options->json, "One JSON object instead of the table");
  add_thresholds(*command, *options);
  command->footer(
      "A threshold that is missed ends it with exit status 1. Everything in one line:\n"
      "  roundel simulate --frames 1000 --camera-out camera.yaml --truth truth.jsonl -o - |\n"
      "    roundel track --camera camera.yaml --json - |\n"
      "    roundel compare --truth truth.jsonl --min-found 99.9 --max-wrong 0 --max-swaps 0 -");
  command->callback([options] { compare(*options); });
}

}  // namespace roundel
