#include "bench/accuracy/reliability.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>
#include <utility>

#include "bench/accuracy/judge.hpp"
#include "bench/common/painter.hpp"
#include "bench/common/placement.hpp"
#include "bench/common/roundel_system.hpp"
#include "core/detector.hpp"
#include "simulator/random.hpp"

namespace roundel::bench {

namespace {

constexpr int kViewsASetting = 100;
constexpr int kForeignEvery = 8;  // settings: one with a code that the reader does not know
constexpr int kBins = 20;
constexpr double kMaxError = 0.02, kMaxWrongOfSure = 1e-4;

// All views of a setting share noise, blur, contrast and size; from easy to hopeless.
Experiment setting(std::uint64_t number) {
  Random random(derived_seed(70, number));
  Experiment e;
  e.name = "reliability";
  e.camera.width = e.camera.height = 160;
  e.camera.fx = e.camera.fy = 400;
  e.camera.cx = e.camera.cy = 79.5;
  const double diameter_px = 12 * std::pow(6, random.uniform());
  e.imaging.black = random.uniform(20, 90);
  e.imaging.white = e.imaging.black + 30 * std::pow(5, random.uniform());
  e.imaging.floor = 0.5 * (e.imaging.black + e.imaging.white);
  e.imaging.noise_sigma = std::pow(40, random.uniform());
  e.imaging.blur_px = 0.3 + 0.08 * diameter_px * random.uniform() * random.uniform();
  e.imaging.exposure_s = 1;
  e.diameter_m = 2 * diameter_px / e.camera.fx;  // at 2 m
  e.markers = 30;
  const double smear_m = random.below(3) == 0 ? e.diameter_m * random.uniform(0, 0.3) : 0;
  for (int i = 0; i < kViewsASetting; ++i) {
    PlacedMarker marker;
    marker.number = static_cast<int>(random.below(30));
    const double x = random.uniform(-0.05, 0.05), y = random.uniform(-0.05, 0.05);
    marker.pose.position = {x, y, 2};
    const double tilt = random.uniform(0, 1.2), axis = random.uniform(0, 2 * std::numbers::pi);
    marker.pose.orientation = tilted(tilt, axis, random.uniform(0, 2 * std::numbers::pi));
    const double direction = random.uniform(0, 2 * std::numbers::pi);
    marker.velocity = smear_m * Eigen::Vector3d(std::cos(direction), std::sin(direction), 0);
    e.views.push_back({random.bits(), {marker}});
  }
  return e;
}

// What the detector reads of a setting's markers, told or not. Empty: no id, or nothing seen.
std::vector<Reading> readings_of(const Experiment& experiment, bool foreign) {
  Experiment printed = experiment;
  if (foreign) printed.bits = experiment.bits + 1;
  Painter painter(printed, whycode_print(printed));
  DetectorParameters parameters = roundel_parameters(experiment, true);
  parameters.min_id_probability = 0;  // every reading counts, with its probability
  Detector detector(parameters, experiment.camera);
  std::vector<Reading> readings;
  GreyImage picture;
  for (const View& view : printed.views) {
    painter.paint(view, picture);
    for (const Marker& marker : detector.detect(picture.view())) {
      if (marker.id < 1) continue;
      const bool right = !foreign && marker.id - 1 == view.markers.front().number;
      readings.push_back({marker.id_probability, right});
    }
  }
  return readings;
}

struct Collection {
  std::vector<Reading> known, foreign;
  int known_views = 0, foreign_views = 0;
};

Collection collect(int views, int jobs) {
  const int settings = std::max(1, views / kViewsASetting);
  std::vector<std::vector<Reading>> parts(static_cast<std::size_t>(settings));
  const auto is_foreign = [](int i) { return i % kForeignEvery == kForeignEvery - 1; };
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < settings; i = next++) {
      parts[static_cast<std::size_t>(i)] =
          readings_of(setting(static_cast<std::uint64_t>(i)), is_foreign(i));
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < jobs; ++i) threads.emplace_back(work);
    work();
  }
  Collection all;
  for (int i = 0; i < settings; ++i) {
    const auto& part = parts[static_cast<std::size_t>(i)];
    auto& readings = is_foreign(i) ? all.foreign : all.known;
    readings.insert(readings.end(), part.begin(), part.end());
    (is_foreign(i) ? all.foreign_views : all.known_views) += kViewsASetting;
  }
  return all;
}

// Sure readings, and how many of them are wrong.
std::pair<int, int> sure_and_wrong(const std::vector<Reading>& readings) {
  int sure = 0, wrong = 0;
  for (const Reading& r : readings) {
    if (r.probability < kSure) continue;
    ++sure;
    if (!r.right) ++wrong;
  }
  return {sure, wrong};
}

}  // namespace

std::vector<ReliabilityBin> reliability_bins(const std::vector<Reading>& readings, int count) {
  std::vector<ReliabilityBin> bins(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    bins[static_cast<std::size_t>(i)].low = static_cast<double>(i) / count;
    bins[static_cast<std::size_t>(i)].high = static_cast<double>(i + 1) / count;
  }
  for (const Reading& reading : readings) {
    const int index = std::clamp(static_cast<int>(reading.probability * count), 0, count - 1);
    ReliabilityBin& bin = bins[static_cast<std::size_t>(index)];
    ++bin.count;
    if (reading.right) ++bin.right;
    bin.mean_probability += (reading.probability - bin.mean_probability) / bin.count;
  }
  return bins;
}

double expected_calibration_error(const std::vector<ReliabilityBin>& bins) {
  double sum = 0;
  int count = 0;
  for (const ReliabilityBin& bin : bins) {
    sum += std::abs(bin.right - bin.count * bin.mean_probability);
    count += bin.count;
  }
  return count > 0 ? sum / count : 0;
}

void write_reliability(std::ostream& csv, std::ostream& markdown, int views, int jobs) {
  const Collection all = collect(views, jobs);
  const auto bins = reliability_bins(all.known, kBins);
  fmt::print(csv, "low,high,count,right,mean_probability,share_right\n");
  for (const ReliabilityBin& bin : bins) {
    if (bin.count == 0) continue;
    fmt::print(csv, "{:g},{:g},{},{},{:.5f},{:.5f}\n", bin.low, bin.high, bin.count, bin.right,
               bin.mean_probability, static_cast<double>(bin.right) / bin.count);
  }
  std::vector<Reading> doubtful;
  for (const Reading& r : all.known) {
    if (r.probability < kSure) doubtful.push_back(r);
  }
  const double error = expected_calibration_error(bins);
  const double doubtful_error = expected_calibration_error(reliability_bins(doubtful, kBins));
  const auto [sure, wrong] = sure_and_wrong(all.known);
  const int foreign_sure = sure_and_wrong(all.foreign).first;
  const double wrong_share = sure > 0 ? static_cast<double>(wrong) / sure : 0;
  fmt::print(markdown, R"(# Is the probability of an id what it says?

Written by `bench/run-accuracy`; do not edit. {} pictures of one marker each, from easy to hopeless: diameter 12
to 72 px, tilt to 70 degrees, contrast 30 to 150, noise 1 to 40, blur to 8 % and motion to 30 % of the diameter.
Single pictures, no memory; every reading counts, however unlikely.

![reliability diagram](reliability.svg)

| | measured | target | |
|---|--:|--:|---|
| ids read | {} | | |
| expected calibration error, {} bins | {:.4f} | ≤ {} | {} |
| the same of readings below {} ({}) | {:.4f} | | |
| readings at {} or more | {} | | |
| wrong ones among them | {} ({:.2g}) | < {} | {} |

A reader must also know what is no id of its set: in {} pictures of markers that wear codes with one bit more,
{} ids were read, {} of them at {} or more.
)",
             all.known_views, all.known.size(), kBins, error, kMaxError,
             error <= kMaxError ? "met" : "**missed**", kSure, doubtful.size(), doubtful_error,
             kSure, sure, wrong, wrong_share, kMaxWrongOfSure,
             wrong_share < kMaxWrongOfSure
                 ? (sure >= 1 / kMaxWrongOfSure ? "met" : "too few to tell")
                 : "**missed**",
             all.foreign_views, all.foreign.size(), foreign_sure, kSure);
}

}  // namespace roundel::bench
