#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/luma_view.hpp"
#include "core/marker_geometry.hpp"
#include "core/necklace.hpp"
#include "core/plane_projection.hpp"
#include "core/segment.hpp"

namespace roundel {

// What the code ring says, read under one hypothesis of the pose.
struct CodeReading {
  int id = -1;             // 1-based; -1: no valid code
  double probability = 0;  // of the id, given this frame alone
  double yaw = 0;  // radians, counter-clockwise on the face, from the projection's x axis to
                   // the start of the canonical word; valid when id > 0
  double edge_scatter =
      0;              // sum of squared deviations of the teeth's edges from their even grid, px^2
  int edges = 0;      // teeth edges that entered the scatter
  double spread = 0;  // of the half-teeth about two colours, share of half their contrast
};

// Reads the necklace code from the ring between the dark disc and the bright centre ([P] 3.1.2;
// METHOD.md sections 4 and 5). Sampling follows the projection, lens included, at a rate that is a
// whole number of samples a half-tooth, so that the grid's phase carries no bias.
class CodeReader {
 public:
  CodeReader(int bits, int hamming) : code_(bits, hamming) {}

  // Nothing when the ring leaves the image or does not look like a code of any id.
  // `mean_radius_px`: of the outer outline.
  std::optional<CodeReading> read(const LumaView& frame, const PlaneProjection& projection,
                                  double mean_radius_px, const Levels& levels);

  const NecklaceCode& code() const { return code_; }

 private:
  static constexpr int kMaxHalves = 2 * kMaxBits;
  static constexpr int kMaxSamplesPerHalf = 16;
  static constexpr int kMaxSamples = kMaxHalves * kMaxSamplesPerHalf;

  // The ring's half-teeth as a model: level_j = mean + slope . direction_j +- half_contrast +
  // noise.
  struct HalfTeeth {
    std::array<double, kMaxHalves> deviation{};  // from the local middle, grey levels
    double half_contrast = 0, sigma = 0;
    std::array<double, 3> middle{};  // mean and slope (cos, sin) of the middle level
  };

  bool sample_ring(const LumaView& frame, const PlaneProjection& projection, double mean_radius_px);
  double grid_phase() const;
  bool fit_half_teeth(double phase, double contrast);
  void decode(CodeReading& reading, int& start_half);
  void measure_edges(double& phase, CodeReading& reading);

  int halves() const { return 2 * code_.bits(); }
  int samples() const { return halves() * per_half_; }
  void take_off_middle();

  NecklaceCode code_;
  int per_half_ = 0;                                // samples a half-tooth in this reading
  std::array<float, kMaxSamples> signal_{};         // grey levels around the ring
  std::array<double, kMaxSamples> height_{};        // the same over the local middle
  std::array<Eigen::Vector2f, kMaxSamples> place_;  // of the samples at the middle radius, pixels
  HalfTeeth teeth_;
};

}  // namespace roundel
