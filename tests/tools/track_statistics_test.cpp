#include "tools/track_statistics.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tests/error_of.hpp"
#include "tools/marker_matching.hpp"

namespace roundel {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Seen from above: the face toward the camera, x to the right.
const Eigen::Quaterniond kFacing(0, 1, 0, 0);

Eigen::Quaterniond turned(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)) * kFacing;
}

MarkerTruth coded(int id, double u) {
  MarkerTruth marker;
  marker.id = id;
  marker.u = u;
  marker.v = 50;
  marker.pose = {{u / 1000, 0, 3}, kFacing};
  marker.visible = true;
  return marker;
}

MarkerTruth plain(double u) {
  MarkerTruth marker = coded(-1, u);
  marker.kind = MarkerKind::WhyCon;
  return marker;
}

MarkerTruth obscured(MarkerTruth marker) {
  marker.visible = false;
  return marker;
}

// What an ideal tracker reports of it.
Marker report(const MarkerTruth& truth, std::int64_t track) {
  Marker marker;
  marker.id = truth.id;
  marker.track = track;
  marker.u = truth.u;
  marker.v = truth.v;
  marker.has_pose = true;
  marker.pose = truth.pose;
  marker.sigma_position = {0.001, 0.001, 0.001};
  return marker;
}

Marker named(Marker marker, int id) {
  marker.id = id;
  return marker;
}

FrameTruth frame(std::vector<MarkerTruth> markers) {
  FrameTruth truth;
  truth.markers = std::move(markers);
  return truth;
}

void add(TrackStatistics& statistics, std::vector<MarkerTruth> truth,
         const std::vector<Marker>& reported) {
  statistics.add(frame(std::move(truth)), reported);
}

}  // namespace

TEST_CASE("a distribution tells mean, median, 99th percentile and the worst") {
  Distribution values;
  CHECK_FALSE(values.summary());
  for (int i = 200; i >= 1; --i) {
    values.add(i);
  }
  const auto summary = values.summary();
  REQUIRE(summary);
  CHECK(summary->mean == 100.5);
  CHECK(summary->median == 100);
  CHECK(summary->p99 == 198);
  CHECK(summary->worst == 200);

  Distribution one;
  one.add(3);
  CHECK(one.summary()->mean == 3);
  CHECK(one.summary()->median == 3);
  CHECK(one.summary()->p99 == 3);
  CHECK(one.summary()->worst == 3);
}

TEST_CASE("the closest pairs belong together, whatever the order") {
  const std::vector<MarkerTruth> truth = {coded(1, 100), coded(2, 104)};
  // Of both, the second true marker is the nearest; the better one gets it.
  const std::vector<Marker> reported = {report(coded(1, 102.5), 1), report(coded(2, 103), 2)};
  const auto matches = match_markers(truth, reported, 5);
  REQUIRE(matches.size() == 2);
  CHECK(matches[0] == 0);
  CHECK(matches[1] == 1);
}

TEST_CASE("nothing is matched further away than allowed, or to a disc, or without an image") {
  std::vector<MarkerTruth> truth = {coded(1, 100), coded(2, 200), coded(3, kNan)};
  truth[1].kind = MarkerKind::Disc;
  const std::vector<Marker> reported = {report(coded(1, 105.1), 1), report(coded(1, 200), 2),
                                        report(coded(1, 104.9), 3)};
  const auto matches = match_markers(truth, reported, 5);
  CHECK_FALSE(matches[0]);
  CHECK_FALSE(matches[1]);
  CHECK(matches[2] == 0);
}

TEST_CASE("visible markers are found or missed, by kind and in whole frames") {
  TrackStatistics s;
  const std::vector<MarkerTruth> all = {coded(1, 100), coded(2, 200), plain(300)};
  add(s, all, {report(all[0], 1), report(all[1], 2), report(all[2], 3)});
  add(s, all, {report(all[0], 1), report(all[1], 2)});
  add(s, {all[0], obscured(all[1]), all[2]}, {report(all[0], 1), report(all[2], 3)});
  add(s, {all[0], obscured(all[1]), all[2]},
      {report(all[0], 1), report(all[1], 2), report(all[2], 3)});
  CHECK(s.frames() == 4);
  CHECK(s.complete_frames() == 3);
  CHECK(s.coded().visible == 6);
  CHECK(s.coded().found == 6);
  CHECK(s.coded().found_obscured == 1);
  CHECK(s.plain().visible == 4);
  CHECK(s.plain().found == 3);
  CHECK(s.plain().missed() == 1);
  CHECK(s.visible() == 10);
  CHECK(s.found() == 9);
  CHECK(s.least_found_share() == 0.75);
  CHECK(s.not_in_truth() == 0);
}

TEST_CASE("a frame without an answer misses everything that is visible") {
  TrackStatistics s;
  const std::vector<MarkerTruth> all = {coded(1, 100), obscured(plain(300))};
  add(s, all, {report(all[0], 1)});
  s.add_unanswered(frame(all));
  CHECK(s.frames() == 2);
  CHECK(s.unanswered_frames() == 1);
  CHECK(s.complete_frames() == 1);
  CHECK(s.coded().missed() == 1);
  CHECK(s.least_found_share() == 0.5);
}

TEST_CASE("a second report of one marker, a disc and thin air are not in the truth") {
  TrackStatistics s;
  MarkerTruth disc = plain(200);
  disc.kind = MarkerKind::Disc;
  const MarkerTruth one = coded(1, 100);
  add(s, {one, disc},
      {report(one, 1), named(report(coded(1, 101), 2), -1), named(report(disc, 3), -1),
       report(coded(7, 400), 4)});
  CHECK(s.not_in_truth() == 3);
  CHECK(s.not_in_truth_with_id() == 1);
  CHECK(s.visible() == 1);
  CHECK(s.found() == 1);
  CHECK(s.complete_frames() == 1);
  CHECK(s.coded().wrong_ids == 0);
}

TEST_CASE("wrong ids are late from the fourth frame of a track on") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100);
  for (int i = 0; i < 5; ++i) {
    add(s, {one}, {named(report(one, 9), 2)});
  }
  CHECK(s.coded().wrong_ids == 5);
  CHECK(s.coded().late_wrong_ids == 2);
  CHECK(s.late_wrong_ids() == 2);
  CHECK(s.coded().missing_ids == 0);
}

TEST_CASE("without track numbers every wrong id counts as late, and there are no swaps") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100), two = coded(2, 200);
  add(s, {one, two}, {named(report(one, 0), 2), named(report(two, 0), 1)});
  CHECK(s.coded().late_wrong_ids == 2);
  CHECK_FALSE(s.has_tracks());
  CHECK(s.swaps() == 0);
}

TEST_CASE("an id that is not read is missing, not wrong; on a plain marker any id is wrong") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100), corner = plain(300);
  add(s, {one, corner}, {named(report(one, 0), -1), named(report(corner, 0), 4)});
  CHECK(s.coded().missing_ids == 1);
  CHECK(s.coded().wrong_ids == 0);
  CHECK(s.plain().missing_ids == 0);
  CHECK(s.plain().wrong_ids == 1);
  CHECK(s.plain().late_wrong_ids == 1);
}

TEST_CASE("a partly hidden marker may be unread but must not bear another's id") {
  TrackStatistics s;
  const MarkerTruth one = obscured(coded(1, 100));
  add(s, {one}, {named(report(one, 0), -1)});
  add(s, {one}, {named(report(one, 0), 2)});
  CHECK(s.coded().missing_ids == 0);
  CHECK(s.coded().wrong_ids == 1);
  CHECK(s.coded().image_px.count() == 0);
}

TEST_CASE("two markers that exchange their tracks are two swaps, once") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100), two = coded(2, 200);
  add(s, {one, two}, {report(one, 1), report(two, 2)});
  CHECK(s.swaps() == 0);
  add(s, {one, two}, {report(one, 2), report(two, 1)});
  add(s, {one, two}, {report(one, 2), report(two, 1)});
  CHECK(s.swaps() == 2);
  CHECK(s.tracks_changed_marker() == 2);
  CHECK(s.markers_changed_track() == 2);
}

TEST_CASE("a visible marker must keep its track, also over frames in which it was missed") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100);
  add(s, {one}, {report(one, 1)});
  add(s, {one}, {});
  add(s, {one}, {report(one, 2)});
  CHECK(s.swaps() == 1);
  CHECK(s.markers_changed_track() == 1);
  CHECK(s.tracks_changed_marker() == 0);
}

TEST_CASE("a marker that was out of sight may come back under another track number") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100);
  add(s, {one}, {report(one, 1)});
  add(s, {obscured(one)}, {});
  add(s, {one}, {report(one, 2)});
  CHECK(s.swaps() == 0);
  // ... but not under one that another had.
  const MarkerTruth two = coded(2, 200);
  TrackStatistics t;
  add(t, {one, obscured(two)}, {report(one, 1)});
  add(t, {obscured(one), two}, {report(two, 1)});
  CHECK(t.swaps() == 1);
  CHECK(t.tracks_changed_marker() == 1);
}

TEST_CASE("errors of position, orientation, normal and image are those made") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100);
  Marker marker = report(one, 1);
  marker.u += 0.3;
  marker.v -= 0.4;
  marker.pose.position += Eigen::Vector3d(0.001, -0.002, 0.002);
  marker.pose.orientation = turned(0.1, Eigen::Vector3d::UnitX());
  add(s, {one}, {marker});
  marker.pose.orientation = turned(0.3, Eigen::Vector3d::UnitZ());  // about the normal
  add(s, {one}, {marker});
  CHECK(s.coded().image_px.summary()->mean == doctest::Approx(0.5));
  CHECK(s.coded().position_m.summary()->mean == doctest::Approx(0.003));
  CHECK(s.coded().orientation_rad.summary()->median == doctest::Approx(0.05));
  CHECK(s.coded().orientation_rad.summary()->worst == doctest::Approx(0.15));
  CHECK(s.coded().normal_rad.summary()->median == doctest::Approx(0).epsilon(1e-9));
  CHECK(s.coded().normal_rad.summary()->worst == doctest::Approx(0.1));
  CHECK(s.coded().flips == 0);
}

TEST_CASE("a normal off by more than 0.2 rad is a flip; plain markers have no yaw to judge") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100), corner = plain(300);
  Marker a = report(one, 1), b = report(corner, 2);
  a.pose.orientation = turned(0.21, Eigen::Vector3d::UnitY());
  b.pose.orientation = turned(2, Eigen::Vector3d::UnitZ()) *
                       Eigen::Quaterniond(Eigen::AngleAxisd(0.19, Eigen::Vector3d::UnitX()));
  add(s, {one, corner}, {a, b});
  CHECK(s.coded().flips == 1);
  CHECK(s.plain().flips == 0);
  CHECK(s.plain().orientation_rad.count() == 0);
  CHECK(s.plain().normal_rad.summary()->worst == doctest::Approx(0.19));
}

TEST_CASE("without poses there is an image error alone") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100);
  Marker marker = report(one, 1);
  marker.has_pose = false;
  add(s, {one}, {marker});
  CHECK(s.coded().found == 1);
  CHECK(s.coded().image_px.count() == 1);
  CHECK(s.coded().position_m.count() == 0);
  CHECK(s.coded().position_sigma.count == 0);
}

TEST_CASE("sigma is held against the error of its axis") {
  TrackStatistics s;
  const MarkerTruth one = coded(1, 100);
  Marker marker = report(one, 1);
  marker.sigma_position = {0.001, 0.002, 0.004};
  marker.pose.position += Eigen::Vector3d(0.003, -0.001, 0.006);
  add(s, {one}, {marker});
  marker.pose.position = one.pose.position;
  add(s, {one}, {marker});
  marker.sigma_position = Eigen::Vector3d::Zero();  // none
  add(s, {one}, {marker});
  const SigmaStatistics& sigma = s.coded().position_sigma;
  CHECK(sigma.count == 2);
  CHECK(sigma.within_one[0] == 1);
  CHECK(sigma.within_one[1] == 2);
  CHECK(sigma.within_one[2] == 1);
  CHECK(sigma.sum_of_squares[0] == doctest::Approx(9));
  CHECK(sigma.sum_of_squares[1] == doctest::Approx(0.25));
  CHECK(sigma.sum_of_squares[2] == doctest::Approx(2.25));
}

TEST_CASE("a truth that lists other markers from frame to frame is refused") {
  const MarkerTruth one = coded(1, 100), two = coded(2, 200);
  const auto refused = [](std::vector<MarkerTruth> first, std::vector<MarkerTruth> second) {
    TrackStatistics s;
    s.add_unanswered(frame(std::move(first)));
    return error_of([&] { s.add_unanswered(frame(std::move(second))); });
  };
  CHECK(refused({one, two}, {one, two}) == "");
  CHECK(refused({one, two}, {two, one}) != "");
  CHECK(refused({one, two}, {one}) != "");
  CHECK(refused({one}, {one, two}) != "");
  CHECK(refused({}, {one}) != "");
  CHECK(refused({plain(1)}, {obscured(plain(2))}) == "");
}

}  // namespace roundel
