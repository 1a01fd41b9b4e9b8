#pragma once

namespace roundel {

// The printed pattern, as ratios to the outer black radius (MARKERS.md sections 1 and 2.1).
inline constexpr double kCodeOuterRatio = 420.0 / 700.0;  // outer end of the teeth
inline constexpr double kCodeInnerRatio = 240.0 / 700.0;  // inner end of the teeth
inline constexpr double kMarginRatio = 899.0 / 700.0;     // white margin around the black disc
inline constexpr double kPlainInnerRatio = 0.4098;   // the reference WhyCon marker: 50 mm in 122 mm
inline constexpr double kPlainInnerRatioMin = 0.33;  // printed variants that are accepted
inline constexpr double kPlainInnerRatioMax = 0.60;

inline constexpr double kDefaultDiameter = 0.122;  // metres, outer black diameter
inline constexpr int kMinBits = 2, kMaxBits = 16;
inline constexpr int kMaxHamming = 4;

}  // namespace roundel
