#include "core/necklace.hpp"

#include <doctest/doctest.h>

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

using roundel::NecklaceCode;
using roundel::rotate_left;

TEST_CASE("the number of ids for each code length is that of the printed sets") {
  constexpr std::array<int, 15> kCounts = {1,  2,   3,   6,   9,    18,   30,  56,
                                           99, 186, 335, 630, 1161, 2182, 4080};
  for (int bits = 2; bits <= 16; ++bits) {
    CAPTURE(bits);
    CHECK(NecklaceCode(bits, 1).id_count() == kCounts[static_cast<std::size_t>(bits - 2)]);
  }
}

TEST_CASE("every id of 3 to 12 bits has the word of the published table") {
  std::ifstream table(ROUNDEL_TEST_DATA "/ids.csv");
  REQUIRE(table.good());
  std::string line;
  std::getline(table, line);
  int rows = 0;
  while (std::getline(table, line)) {
    int bits = 0, id = 0;
    unsigned word = 0;
    char comma = 0;
    std::istringstream(line) >> bits >> comma >> id >> comma >> word;
    CAPTURE(line);
    REQUIRE(NecklaceCode(bits, 1).word(id) == word);
    ++rows;
  }
  CHECK(rows == 744);
}

TEST_CASE("sets with a minimum Hamming distance hold the words of the published lists") {
  const auto words = [](int bits, int hamming) {
    const NecklaceCode code(bits, hamming);
    std::vector<unsigned> list;
    for (int id = 1; id <= code.id_count(); ++id) list.push_back(*code.word(id));
    return list;
  };
  CHECK(words(8, 2) ==
        std::vector<unsigned>{1, 7, 11, 13, 19, 21, 25, 31, 37, 47, 55, 59, 61, 87, 91, 127});
  CHECK(words(10, 3) == std::vector<unsigned>{1, 15, 51, 85, 91, 157, 255});
  CHECK(words(12, 4) == std::vector<unsigned>{1, 31, 103, 171, 181, 211, 493, 587, 767, 823});
  CHECK(words(14, 2).size() == 585);
  CHECK(words(14, 3).size() == 48);
}

TEST_CASE("a word in any rotation decodes to its id and the rotation that restores it") {
  for (int bits = 2; bits <= 12; ++bits) {
    const NecklaceCode code(bits, 1);
    for (int id = 1; id <= code.id_count(); ++id) {
      for (int turn = 0; turn < bits; ++turn) {
        const unsigned turned = rotate_left(*code.word(id), turn, bits);
        const auto reading = code.decode(turned);
        REQUIRE(reading.has_value());
        CHECK(reading->id == id);
        CHECK(rotate_left(turned, reading->rotation, bits) == *code.word(id));
      }
    }
  }
}

TEST_CASE("periodic words and ids outside the set decode to nothing") {
  const NecklaceCode code(8, 1);
  CHECK_FALSE(code.decode(0b00000000).has_value());
  CHECK_FALSE(code.decode(0b11111111).has_value());
  CHECK_FALSE(code.decode(0b01010101).has_value());
  CHECK_FALSE(code.decode(0b00110011).has_value());
  CHECK_FALSE(code.decode(1U << 8).has_value());
  CHECK_FALSE(code.word(0).has_value());
  CHECK_FALSE(code.word(31).has_value());
}

TEST_CASE("impossible code lengths and distances are refused with what would be right") {
  CHECK_THROWS_WITH_AS(NecklaceCode(1, 1), doctest::Contains("use 2 to 16"), std::invalid_argument);
  CHECK_THROWS_WITH_AS(NecklaceCode(17, 1), doctest::Contains("use 2 to 16"),
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(NecklaceCode(8, 5), doctest::Contains("use 1 to 4"), std::invalid_argument);
  CHECK_THROWS_WITH_AS(NecklaceCode(8, 0), doctest::Contains("use 1 to 4"), std::invalid_argument);
}
