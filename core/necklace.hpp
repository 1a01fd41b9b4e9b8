#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace roundel {

// What a word read from the ring means.
struct NecklaceReading {
  int id = -1;  // 1-based
  int rotation =
      0;  // left rotations by one bit that turn the word read into the id's canonical word
};

// The id set of a code length and minimum Hamming distance: aperiodic binary necklaces in
// increasing order, numbered from 1 (MARKERS.md section 2.3). Words are `bits` wide, most
// significant bit first. Immutable after construction.
class NecklaceCode {
 public:
  // bits in [2, 16], hamming in [1, 4]; otherwise std::invalid_argument that says so.
  NecklaceCode(int bits, int hamming);

  int bits() const { return bits_; }
  int hamming() const { return hamming_; }
  int id_count() const { return static_cast<int>(words_.size()); }

  // The canonical (smallest) word of an id in [1, id_count()]; nothing for other ids.
  std::optional<std::uint32_t> word(int id) const;

  // The id of a word in any rotation; nothing for words outside the set. No allocation, O(1).
  std::optional<NecklaceReading> decode(std::uint32_t word) const;

 private:
  int bits_ = 0;
  int hamming_ = 0;
  std::vector<std::uint32_t> words_;      // by id - 1
  std::vector<std::int16_t> id_of_word_;  // by word; 0 = none
};

// Rotates a word of `bits` bits to the left by `count` in [0, bits).
std::uint32_t rotate_left(std::uint32_t word, int count, int bits);

}  // namespace roundel
