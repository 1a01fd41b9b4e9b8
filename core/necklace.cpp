#include "core/necklace.hpp"

#include <bit>
#include <stdexcept>
#include <string>

#include "core/marker_geometry.hpp"

namespace roundel {

std::uint32_t rotate_left(std::uint32_t word, int count, int bits) {
  const std::uint32_t mask = (1U << bits) - 1U;
  return ((word << count) | (word >> (bits - count))) & mask;
}

namespace {

// Smallest of its own rotations, and equal to none of them.
bool is_aperiodic_necklace(std::uint32_t word, int bits) {
  for (int r = 1; r < bits; ++r) {
    if (rotate_left(word, r, bits) <= word) return false;
  }
  return true;
}

bool is_distant(std::uint32_t word, int bits, int hamming,
                const std::vector<std::uint32_t>& accepted) {
  for (int r = 0; r < bits; ++r) {
    const std::uint32_t rotated = rotate_left(word, r, bits);
    for (const std::uint32_t other : accepted) {
      if (std::popcount(rotated ^ other) < hamming) return false;
    }
  }
  return true;
}

}  // namespace

NecklaceCode::NecklaceCode(int bits, int hamming) : bits_(bits), hamming_(hamming) {
  if (bits < kMinBits || bits > kMaxBits) {
    throw std::invalid_argument("a code of " + std::to_string(bits) + " bits does not exist; use " +
                                std::to_string(kMinBits) + " to " + std::to_string(kMaxBits));
  }
  if (hamming < 1 || hamming > kMaxHamming) {
    throw std::invalid_argument("minimum Hamming distance " + std::to_string(hamming) +
                                " is not supported; use 1 to " + std::to_string(kMaxHamming) +
                                " (above, printed sets have one or two ids)");
  }
  const std::uint32_t count = 1U << bits;
  id_of_word_.assign(count, 0);
  for (std::uint32_t word = 0; word < count; ++word) {
    if (!is_aperiodic_necklace(word, bits)) continue;
    if (hamming > 1 && !is_distant(word, bits, hamming, words_)) continue;
    words_.push_back(word);
    for (int r = 0; r < bits; ++r) {
      id_of_word_[rotate_left(word, r, bits)] = static_cast<std::int16_t>(words_.size());
    }
  }
}

std::optional<std::uint32_t> NecklaceCode::word(int id) const {
  if (id < 1 || id > id_count()) return std::nullopt;
  return words_[static_cast<std::size_t>(id - 1)];
}

std::optional<NecklaceReading> NecklaceCode::decode(std::uint32_t word) const {
  if (word >= id_of_word_.size() || id_of_word_[word] == 0) return std::nullopt;
  NecklaceReading reading;
  reading.id = id_of_word_[word];
  const std::uint32_t canonical = words_[static_cast<std::size_t>(reading.id - 1)];
  while (rotate_left(word, reading.rotation, bits_) != canonical) ++reading.rotation;
  return reading;
}

}  // namespace roundel
