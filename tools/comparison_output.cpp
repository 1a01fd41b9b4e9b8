#include "tools/comparison_output.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1e3;
constexpr std::size_t kLabelWidth = 42;

std::optional<double> percent(std::int64_t part, std::int64_t whole) {
  if (whole == 0) {
    return std::nullopt;
  }
  return 100 * static_cast<double>(part) / static_cast<double>(whole);
}

std::optional<double> percent(const std::optional<double>& share) {
  return share ? std::optional(100 * *share) : std::nullopt;
}

struct Honesty {
  std::array<double, 3> within_one_percent{}, mean_square{};
};

std::optional<Honesty> honesty(const SigmaStatistics& sigma) {
  if (sigma.count == 0) {
    return std::nullopt;
  }
  Honesty result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.within_one_percent[axis] = *percent(sigma.within_one[axis], sigma.count);
    result.mean_square[axis] = sigma.sum_of_squares[axis] / static_cast<double>(sigma.count);
  }
  return result;
}

class Table {
 public:
  template <typename Cell>
  void row(std::string_view label, const std::vector<Cell>& cells, std::string_view format) {
    fmt::format_to(std::back_inserter(text_), "{:<{}}", label, kLabelWidth);
    for (const Cell& cell : cells) {
      fmt::format_to(std::back_inserter(text_), "{:>11}", fmt::format(fmt::runtime(format), cell));
    }
    text_ += '\n';
  }

  void head(std::string_view label, const std::vector<std::string_view>& columns) {
    text_ += text_.empty() ? "" : "\n";
    row(label, columns, "{}");
  }

  void count(std::string_view label, std::int64_t coded, std::int64_t plain) {
    row(label, std::vector{coded, plain, coded + plain}, "{}");
  }

  // One number under "all".
  void total(std::string_view label, std::string_view value) {
    row(label, std::vector<std::string_view>{"", "", value}, "{}");
  }

  void spread(std::string_view label, const Distribution& values, double scale) {
    if (const auto s = values.summary()) {
      row(label, std::vector{s->mean * scale, s->median * scale, s->p99 * scale, s->worst * scale},
          "{:.4f}");
    }
  }

  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

std::string percent_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "-";
}

void add_counts(Table& table, const TrackStatistics& s) {
  const MarkerStatistics &coded = s.coded(), &plain = s.plain();
  table.head(fmt::format("{} frames", s.frames()), {"coded", "plain", "all"});
  table.count("visible markers", coded.visible, plain.visible);
  table.count("  found", coded.found, plain.found);
  table.row("  found, %",
            std::vector{percent_text(percent(coded.found, coded.visible)),
                        percent_text(percent(plain.found, plain.visible)),
                        percent_text(percent(s.found(), s.visible()))},
            "{}");
  table.total("  the one missed most: found, %", percent_text(percent(s.least_found_share())));
  table.count("  missed", coded.missed(), plain.missed());
  table.total("frames with all visible markers, %",
              percent_text(percent(s.complete_frames(), s.frames())));
  table.total("frames without an answer", fmt::to_string(s.unanswered_frames()));
  table.count("found though partly hidden or cut", coded.found_obscured, plain.found_obscured);
  table.total("not in the truth", fmt::to_string(s.not_in_truth()));
  table.total("  with an id", fmt::to_string(s.not_in_truth_with_id()));
  table.count("wrong ids", coded.wrong_ids, plain.wrong_ids);
  table.count(fmt::format("  after the first {} frames of a track", TrackStatistics::kFirstFrames),
              coded.late_wrong_ids, plain.late_wrong_ids);
  table.row("ids missing",
            std::vector{fmt::to_string(coded.missing_ids), std::string("-"),
                        fmt::to_string(coded.missing_ids)},
            "{}");
  table.count(fmt::format("flips (normal off by more than {} rad)", TrackStatistics::kFlip),
              coded.flips, plain.flips);
  if (s.has_tracks()) {
    table.total("id swaps", fmt::to_string(s.swaps()));
    table.total("  a track changed its marker", fmt::to_string(s.tracks_changed_marker()));
    table.total("  a visible marker changed its track", fmt::to_string(s.markers_changed_track()));
  }
}

void add_accuracy(Table& table, std::string_view name, const MarkerStatistics& s) {
  if (s.found == 0) {
    return;
  }
  table.head(fmt::format("{} markers", name), {"mean", "median", "99 %", "worst"});
  table.spread("position error, mm", s.position_m, kMillimetres);
  table.spread("orientation error arccos |q1 q2|, rad", s.orientation_rad, 1);
  table.spread("normal error, rad", s.normal_rad, 1);
  table.spread("image error, px", s.image_px, 1);
  if (const auto h = honesty(s.position_sigma)) {
    const auto list = [](const std::array<double, 3>& v) {
      return std::vector(v.begin(), v.end());
    };
    table.head(fmt::format("{} markers, sigma of position", name), {"x", "y", "z"});
    table.row("within one sigma, % (honest: 68.3)", list(h->within_one_percent), "{:.1f}");
    table.row("mean of (error / sigma)^2 (honest: 1)", list(h->mean_square), "{:.2f}");
  }
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json spread_json(const Distribution& values, double scale = 1) {
  const auto s = values.summary();
  if (!s) {
    return nullptr;
  }
  return {{"mean", s->mean * scale},
          {"median", s->median * scale},
          {"p99", s->p99 * scale},
          {"worst", s->worst * scale}};
}

Json markers_json(const MarkerStatistics& s) {
  const auto h = honesty(s.position_sigma);
  return {{"visible", s.visible},
          {"found", s.found},
          {"found_percent", optional_json(percent(s.found, s.visible))},
          {"missed", s.missed()},
          {"found_obscured", s.found_obscured},
          {"wrong_ids", s.wrong_ids},
          {"late_wrong_ids", s.late_wrong_ids},
          {"missing_ids", s.missing_ids},
          {"flips", s.flips},
          {"position_error_mm", spread_json(s.position_m, kMillimetres)},
          {"orientation_error", spread_json(s.orientation_rad)},
          {"normal_error", spread_json(s.normal_rad)},
          {"image_error_px", spread_json(s.image_px)},
          {"within_one_sigma_percent", h ? Json(h->within_one_percent) : Json(nullptr)},
          {"mean_square_error_over_sigma", h ? Json(h->mean_square) : Json(nullptr)}};
}

}  // namespace

std::string comparison_text(const TrackStatistics& statistics) {
  Table table;
  add_counts(table, statistics);
  add_accuracy(table, "coded", statistics.coded());
  add_accuracy(table, "plain", statistics.plain());
  return std::move(table).text();
}

Json comparison_json(const TrackStatistics& s) {
  const auto if_tracked = [&](std::int64_t count) {
    return s.has_tracks() ? Json(count) : Json(nullptr);
  };
  return {{"frames", s.frames()},
          {"unanswered_frames", s.unanswered_frames()},
          {"complete_frames", s.complete_frames()},
          {"visible", s.visible()},
          {"found", s.found()},
          {"found_percent", optional_json(percent(s.found(), s.visible()))},
          {"least_found_percent", optional_json(percent(s.least_found_share()))},
          {"not_in_truth", s.not_in_truth()},
          {"not_in_truth_with_id", s.not_in_truth_with_id()},
          {"late_wrong_ids", s.late_wrong_ids()},
          {"swaps", if_tracked(s.swaps())},
          {"tracks_changed_marker", if_tracked(s.tracks_changed_marker())},
          {"markers_changed_track", if_tracked(s.markers_changed_track())},
          {"coded", markers_json(s.coded())},
          {"plain", markers_json(s.plain())}};
}

}  // namespace roundel
