#pragma once

#include <cstddef>
#include <cstdint>

#include "core/vector_unit.hpp"

namespace roundel {

// The work of RowScanner that every pixel of a picture takes part in, compiled for several vector
// units; the results are the same.
struct LineKernels {
  static constexpr int kBlock = 16;         // pixels
  static constexpr int kBlocksAtOnce = 64;  // what is bounded comes in multiples of so many blocks

  // Averages of 2 x 2 pixels of two rows; `count` of them, each with a neighbour to its right.
  void (*average)(const std::uint8_t* upper, const std::uint8_t* lower, std::ptrdiff_t pixel_stride,
                  int count, std::uint8_t* out);

  // Least and greatest level of every block.
  void (*bound)(const std::uint8_t* line, std::size_t blocks, std::uint8_t* low,
                std::uint8_t* high);

  // What a block and its two neighbours say about it; `low` and `high` have one more block at
  // either end. Flags are 0 or 255.
  struct BlockLooks {
    std::uint8_t* threshold;   // half way between the extremes
    std::uint8_t* middle;      // level of the block itself
    std::uint8_t* contrasted;  // the extremes are `contrast` apart
    std::uint8_t* crossing;    // and the block itself has pixels on both sides of the threshold
  };
  void (*judge)(const std::uint8_t* low, const std::uint8_t* high, std::size_t blocks,
                std::uint8_t contrast, const BlockLooks& looks);
};

const LineKernels& line_kernels(VectorUnit unit = VectorUnit::kBest);

}  // namespace roundel
