#include "tools/pose_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "transport/messages.hpp"

namespace roundel {
namespace {

constexpr std::int64_t kPeriodUs = 1'000'000;
constexpr double kDegrees = 180 / std::numbers::pi;

auto order(const marker_t& marker) {
  const std::int32_t id = marker.id < 0 ? std::numeric_limits<std::int32_t>::max() : marker.id;
  return std::tuple(id, marker.track);
}

// Direction of the marker's x axis in the image, from right toward down, degrees.
double yaw_degrees(const Marker& marker) {
  const Eigen::Vector3d x_axis = marker.pose.orientation * Eigen::Vector3d::UnitX();
  return std::atan2(x_axis.y(), x_axis.x()) * kDegrees;
}

std::string row_text(const marker_t& message, double rate) {
  const Marker marker = from_message(message);
  const std::string id = marker.id < 0 ? "?" : std::to_string(marker.id);
  std::string text =
      fmt::format("{:>5} {:>6} {:7.1f} {:7.1f}", id, marker.track, marker.u, marker.v);
  if (!marker.has_pose) return text + fmt::format("{:>47} {:6.1f}\n", "no pose", rate);
  const Eigen::Vector3d& p = marker.pose.position;
  // Without a code the direction about the normal is not known.
  const std::string yaw = marker.id < 0 ? "-" : fmt::format("{:.1f}", yaw_degrees(marker));
  text += fmt::format(" {:8.3f} {:8.3f} {:8.3f} {:>7} {:8.2f} {:6.1f}", p.x(), p.y(), p.z(), yaw,
                      marker.sigma_position.norm() * 1000, rate);
  if (message.has_arena != 0) {
    const std::string heading =
        marker.id < 0 ? "-" : fmt::format("{:.1f}", message.arena_heading * kDegrees);
    text += fmt::format("  {:8.3f} {:8.3f} {:8.3f} {:>7}", message.arena_x, message.arena_y,
                        message.arena_z, heading);
  }
  return text + "\n";
}

// What is wrong with the arena's calibration, if anything is.
const char* arena_text(int state) {
  switch (state) {
    case header_t::ARENA_OTHER_CAMERA:
      return ", arena calibration not used (roundel status)";
    case header_t::ARENA_MOVED:
      return ", CAMERA MOVED since the arena was calibrated";
    default:
      return "";
  }
}

const char* calibration_text(int state) {
  switch (state) {
    case header_t::CALIBRATION_VALID:
      return "calibrated";
    case header_t::CALIBRATION_OTHER_RESOLUTION:
      return "calibrated for another resolution";
    default:
      return "not calibrated";
  }
}

}  // namespace

void PoseTable::add(const ReceivedFrame& frame, const ReceptionCounts& counts,
                    std::int64_t received_utime, std::int64_t now_us) {
  if (period_start_us_ == 0) period_start_us_ = now_us;
  if (frame.header.session != header_.session) rows_.clear();  // tracks are numbered anew
  header_ = frame.header;
  camera_ = frame.camera;
  counts_ = counts;
  latency_ms_ = static_cast<double>(received_utime - header_.capture_utime) / 1000;
  ++frames_;
  for (const marker_t& marker : frame.markers) {
    auto row = std::find_if(rows_.begin(), rows_.end(),
                            [&](const Row& r) { return r.marker.track == marker.track; });
    if (row == rows_.end()) row = rows_.insert(rows_.end(), Row{});
    row->marker = marker;
    row->seen_us = now_us;
    ++row->frames;
  }
}

void PoseTable::end_period(std::int64_t now_us) {
  const std::int64_t elapsed_us = now_us - period_start_us_;
  if (period_start_us_ == 0 || (elapsed_us < kPeriodUs && periods_ > 0)) return;
  const double elapsed_s = std::max(1e-3, static_cast<double>(elapsed_us) / 1e6);
  rate_ = frames_ / elapsed_s;
  for (Row& row : rows_) row.rate = row.frames / elapsed_s;
  if (elapsed_us < kPeriodUs) return;  // the first period is shown while it grows
  frames_ = 0;
  for (Row& row : rows_) row.frames = 0;
  ++periods_;
  period_start_us_ = now_us;
}

std::string PoseTable::heading() const {
  return fmt::format(
      "{}{}, {}x{}, {}{}; frame {}, {:.1f} frames/s, latency {:.1f} ms, tracking {:.2f} ms, "
      "dropped "
      "{}, lost {}\n",
      camera_, header_.simulated != 0 ? " (simulated)" : "", header_.width, header_.height,
      calibration_text(header_.calibration_state), arena_text(header_.arena_state), header_.frame,
      rate_, latency_ms_, header_.tracking_us / 1000, header_.dropped, counts_.lost);
}

std::string PoseTable::text(std::size_t max_rows, std::int64_t now_us) {
  if (counts_.frames == 0) return "no frame has arrived yet\n";
  std::erase_if(rows_, [&](const Row& row) { return now_us - row.seen_us > kPeriodUs; });
  end_period(now_us);
  std::sort(rows_.begin(), rows_.end(),
            [](const Row& a, const Row& b) { return order(a.marker) < order(b.marker); });
  std::string text = heading();
  text += fmt::format("{:>5} {:>6} {:>7} {:>7} {:>8} {:>8} {:>8} {:>7} {:>8} {:>6}{}\n", "id",
                      "track", "u", "v", "x m", "y m", "z m", "yaw", "sigma mm", "Hz",
                      header_.arena_mode != 0 ? "   arena x        y        z heading" : "");
  const std::size_t shown = std::min(max_rows, rows_.size());
  for (std::size_t i = 0; i < shown; ++i) text += row_text(rows_[i].marker, rows_[i].rate);
  if (shown < rows_.size()) text += fmt::format("... and {} more\n", rows_.size() - shown);
  return text;
}

}  // namespace roundel
