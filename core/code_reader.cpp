#include "core/code_reader.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/bilinear.hpp"

namespace roundel {

namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kMiddleRadius = (kCodeOuterRatio + kCodeInnerRatio) / 2;
// A second and third circle within the teeth, for markers large enough that blur from the ring's
// rims does not reach them.
constexpr double kRadiusStep = 0.05;
constexpr double kMinRadiusForThree = 14;  // pixels

// A ring whose half-teeth differ by less than this share of the marker's contrast carries no code.
constexpr double kMinCodeContrast = 0.2;
// Half-teeth that scatter by more of half the code's contrast are no two colours. Codes down to 14
// px across stay below 0.45; a square in a ring, the likest thing that is none, has 1.2.
constexpr double kMaxSpread = 0.75;
// Spread of a half-tooth's level about its model that no residual may fall below, share of the
// code's contrast: interpolation, print and light are never perfect.
constexpr double kMinSpread = 0.06;
// Chance of a half-tooth being spoilt (glare, dirt), and of the ring carrying something else than a
// code of the set.
constexpr double kSpoilt = 0.01, kNoCode = 0.05;
// Half-teeth that scatter by more of half the code's contrast err together (motion, a pose that is
// off, a code of another length), which the likelihood of one by one knows nothing of: of such
// readings none is surer than so. Of 57 000 readings at 0.99 or more, from easy to hopeless, 24
// were wrong, 21 of them of such a scatter.
constexpr double kDoubtfulSpread = 0.42, kSurestOfDoubtful = 0.985;

}  // namespace

bool CodeReader::sample_ring(const LumaView& frame, const PlaneProjection& projection,
                             double mean_radius_px) {
  const double half_arc = kTwoPi * kMiddleRadius * mean_radius_px / halves();
  per_half_ = std::clamp(static_cast<int>(std::ceil(1.5 * half_arc)), 4, kMaxSamplesPerHalf);
  const int count = samples();
  const int circles = mean_radius_px >= kMinRadiusForThree ? 3 : 1;
  // The unit vector is turned step by step: cheaper than a sine a sample and exact enough.
  const std::complex<double> turn = std::polar(1.0, kTwoPi / count);
  std::complex<double> direction = 1;
  for (int k = 0; k < count; ++k, direction *= turn) {
    double sum = 0;
    for (int circle = 0; circle < circles; ++circle) {
      const double radius = kMiddleRadius + (circle == 0   ? 0.0
                                             : circle == 1 ? -kRadiusStep
                                                           : kRadiusStep);
      const Eigen::Vector2d p =
          projection.pixel(radius * direction.real(), radius * direction.imag());
      if (!can_interpolate(frame, p.x(), p.y())) return false;
      if (circle == 0) place_[static_cast<std::size_t>(k)] = p.cast<float>();
      sum += interpolate(frame, p.x(), p.y());
    }
    signal_[static_cast<std::size_t>(k)] = static_cast<float>(sum / circles);
  }
  return true;
}

double CodeReader::grid_phase() const {
  // Circular mean of the places of change, weighted by the change's square: noise adds no bias.
  const int count = samples();
  std::complex<double> sum = 0;
  const std::complex<double> turn = std::polar(1.0, kTwoPi / per_half_);
  std::complex<double> direction = std::polar(1.0, std::numbers::pi / per_half_);
  for (int k = 0; k < count; ++k, direction *= turn) {
    const double change = signal_[static_cast<std::size_t>(k + 1 == count ? 0 : k + 1)] -
                          signal_[static_cast<std::size_t>(k)];
    sum += change * change * direction;
  }
  double phase = std::arg(sum) / kTwoPi * per_half_;
  if (phase < 0) phase += per_half_;
  return phase;  // in samples, [0, per_half_]: a border between half-teeth
}

void CodeReader::take_off_middle() {
  const int count = samples();
  const std::complex<double> turn = std::polar(1.0, kTwoPi / count);
  std::complex<double> direction = 1;
  for (int k = 0; k < count; ++k, direction *= turn) {
    const auto at = static_cast<std::size_t>(k);
    height_[at] = signal_[at] - teeth_.middle[0] - teeth_.middle[1] * direction.real() -
                  teeth_.middle[2] * direction.imag();
  }
}

bool CodeReader::fit_half_teeth(double phase, double contrast) {
  const int half_count = halves(), count = samples();
  std::array<double, kMaxHalves> level{};
  for (int j = 0; j < half_count; ++j) {
    // The inner part of the half-tooth, away from its blurred borders.
    const double middle = phase + (j + 0.5) * per_half_, reach = 0.3 * per_half_;
    const int first = static_cast<int>(std::ceil(middle - reach));
    const int last = std::max(first, static_cast<int>(std::floor(middle + reach)));
    double sum = 0;
    for (int k = first; k <= last; ++k)
      sum += signal_[static_cast<std::size_t>((k + count) % count)];
    level[static_cast<std::size_t>(j)] = sum / (last - first + 1);
  }
  // Manchester pairs compare neighbours, which no slope of light can spoil: the pairing with the
  // larger differences gives each half-tooth's colour.
  const auto at = [&](int j) { return level[static_cast<std::size_t>(j % half_count)]; };
  std::array<double, 2> energy{};
  for (int j = 0; j < half_count; ++j)
    energy[static_cast<std::size_t>(j % 2)] += std::abs(at(j) - at(j + 1));
  const int parity = energy[1] > energy[0] ? 1 : 0;
  std::array<double, kMaxHalves> colour{};
  for (int j = parity; j < half_count + parity; j += 2) {
    const double sign = at(j) > at(j + 1) ? 1 : -1;
    colour[static_cast<std::size_t>(j % half_count)] = sign;
    colour[static_cast<std::size_t>((j + 1) % half_count)] = -sign;
  }
  // level = mean + cos, sin slope + half_contrast * colour. Short codes leave no room for a slope.
  const int unknowns = code_.bits() >= 4 ? 4 : 2;
  Eigen::Matrix4d normal_matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right_side = Eigen::Vector4d::Zero();
  std::array<Eigen::Vector4d, kMaxHalves> rows;
  for (int j = 0; j < half_count; ++j) {
    const double angle = kTwoPi * (phase + (j + 0.5) * per_half_) / count;
    Eigen::Vector4d& row = rows[static_cast<std::size_t>(j)];
    row << 1, colour[static_cast<std::size_t>(j)], std::cos(angle), std::sin(angle);
    if (unknowns == 2) row.tail<2>().setZero();
    normal_matrix += row * row.transpose();
    right_side += row * at(j);
  }
  if (unknowns == 2) normal_matrix(2, 2) = normal_matrix(3, 3) = 1;
  const Eigen::Vector4d fit = normal_matrix.ldlt().solve(right_side);
  teeth_.half_contrast = fit[1];
  teeth_.middle = {fit[0], fit[2], fit[3]};
  if (!(2 * teeth_.half_contrast >= kMinCodeContrast * contrast)) return false;
  double squares = 0;
  for (int j = 0; j < half_count; ++j) {
    const Eigen::Vector4d& row = rows[static_cast<std::size_t>(j)];
    const double deviation = at(j) - fit[0] - fit[2] * row[2] - fit[3] * row[3];
    teeth_.deviation[static_cast<std::size_t>(j)] = deviation;
    const double residual = deviation - fit[1] * row[1];
    squares += residual * residual;
  }
  const double floor = kMinSpread * 2 * teeth_.half_contrast;
  teeth_.sigma = std::sqrt(squares / std::max(1, half_count - unknowns) + floor * floor);
  return teeth_.sigma <= kMaxSpread * teeth_.half_contrast;
}

void CodeReader::decode(CodeReading& reading, int& start_half) {
  const int bits = code_.bits(), half_count = halves();
  // Log-likelihood of each half-tooth being bright or dark.
  std::array<double, kMaxHalves> bright{}, dark{};
  double none = 0;  // every half-tooth any colour: specks, dirt, another code
  const double spoilt = kSpoilt / (4 * teeth_.half_contrast);
  const auto log_density = [&](double deviation) {
    const double z = deviation / teeth_.sigma;
    return std::log((1 - kSpoilt) * std::exp(-0.5 * z * z) / (teeth_.sigma * std::sqrt(kTwoPi)) +
                    spoilt);
  };
  for (std::size_t j = 0; j < static_cast<std::size_t>(half_count); ++j) {
    bright[j] = log_density(teeth_.deviation[j] - teeth_.half_contrast);
    dark[j] = log_density(teeth_.deviation[j] + teeth_.half_contrast);
    const double best = std::max(bright[j], dark[j]);
    none += best + std::log(0.5 * (std::exp(bright[j] - best) + std::exp(dark[j] - best)));
  }
  // Words worth a look, for both pairings of half-teeth: the likeliest, and those that differ from
  // it in one or two bits. All others are less likely by orders of magnitude.
  struct Best {
    double score = -std::numeric_limits<double>::infinity();
    int id = -1, start = 0;
  } best;
  double reference = none;  // exponents are taken relative to it, to stay in range
  double total = 0;         // of all candidates, relative to reference
  const double log_prior = std::log((1 - kNoCode) / (2.0 * bits * code_.id_count()));
  for (int pass = 0; pass < 2; ++pass) {
    for (int parity = 0; parity < 2; ++parity) {
      std::array<double, kMaxBits> loss{};  // of flipping a bit
      std::uint32_t word = 0;
      double score = log_prior;
      for (int i = 0; i < bits; ++i) {
        const auto first = static_cast<std::size_t>((parity + 2 * i) % half_count);
        const auto second = static_cast<std::size_t>((parity + 2 * i + 1) % half_count);
        const double one = bright[first] + dark[second], zero = dark[first] + bright[second];
        word = (word << 1) | (one > zero ? 1U : 0U);
        score += std::max(one, zero);
        loss[static_cast<std::size_t>(bits - 1 - i)] = std::abs(one - zero);  // by bit position
      }
      const auto consider = [&](std::uint32_t candidate, double candidate_score) {
        if (pass == 0 && candidate_score <= best.score) return;
        const auto decoded = code_.decode(candidate);
        if (pass == 0) {
          if (decoded) {
            best = {candidate_score, decoded->id, (parity + 2 * decoded->rotation) % half_count};
          }
        } else {
          // Words outside the set count as well: what reads most like one of them is no id.
          const double weight = std::exp(candidate_score - reference);
          total += weight;
          if (decoded && decoded->id == best.id) reading.probability += weight;
        }
      };
      consider(word, score);
      for (int i = 0; i < bits; ++i) {
        const double once = score - loss[static_cast<std::size_t>(i)];
        consider(word ^ (1U << i), once);
        for (int k = 0; k < i; ++k) {
          consider(word ^ (1U << i) ^ (1U << k), once - loss[static_cast<std::size_t>(k)]);
        }
      }
    }
    if (best.id < 0) return;
    reference = best.score;
  }
  total += kNoCode * std::exp(none - reference);
  reading.id = best.id;
  reading.probability /= total;
  if (reading.spread > kDoubtfulSpread) {
    reading.probability = std::min(reading.probability, kSurestOfDoubtful);
  }
  start_half = best.start;
}

void CodeReader::measure_edges(double& phase, CodeReading& reading) {
  take_off_middle();
  const int half_count = halves(), count = samples();
  // Signed so that no index below turns negative, whatever the phase.
  const auto wrap = [count](int k) { return static_cast<std::size_t>((k + 2 * count) % count); };
  const auto height = [&](int k) { return height_[wrap(k)]; };
  struct Edge {
    double deviation, weight;  // samples; square of pixels a sample
  };
  std::array<Edge, kMaxHalves> edges{};
  std::size_t found = 0;
  double weighted = 0, weights = 0;
  for (int j = 0; j < half_count; ++j) {
    const double left = teeth_.deviation[static_cast<std::size_t>(j)];
    const double right = teeth_.deviation[static_cast<std::size_t>((j + 1) % half_count)];
    if ((left > 0) == (right > 0)) continue;
    const double expected = phase + (j + 1) * per_half_;
    const int reach = (per_half_ + 1) / 2;
    const int middle = static_cast<int>(std::lround(expected));
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = middle - reach; k < middle + reach; ++k) {
      const double h0 = height(k), h1 = height(k + 1);
      if ((h0 > 0) == (h1 > 0) || (h1 > 0) != (right > 0)) continue;
      const double deviation = k + h0 / (h0 - h1) - expected;
      if (std::abs(deviation) < std::abs(nearest)) nearest = deviation;
    }
    if (!std::isfinite(nearest)) continue;
    const double pixels = (place_[wrap(middle + 1)] - place_[wrap(middle)]).norm();
    edges[found++] = {nearest, pixels * pixels};
    weighted += nearest * pixels * pixels;
    weights += pixels * pixels;
  }
  if (found == 0) return;
  const double mean = weighted / weights;
  phase += mean;
  for (std::size_t i = 0; i < found; ++i) {
    const double rest = edges[i].deviation - mean;
    reading.edge_scatter += edges[i].weight * rest * rest;
  }
  reading.edges = static_cast<int>(found);
}

std::optional<CodeReading> CodeReader::read(const LumaView& frame,
                                            const PlaneProjection& projection,
                                            double mean_radius_px, const Levels& levels) {
  if (!sample_ring(frame, projection, mean_radius_px)) return std::nullopt;
  double phase = grid_phase();
  if (!fit_half_teeth(phase, levels.contrast())) return std::nullopt;
  CodeReading reading;
  reading.spread = teeth_.sigma / teeth_.half_contrast;
  int start_half = 0;
  decode(reading, start_half);
  measure_edges(phase, reading);
  if (reading.id > 0) {
    reading.yaw = std::remainder(kTwoPi * (phase + start_half * per_half_) / samples(), kTwoPi);
  }
  return reading;
}

}  // namespace roundel
