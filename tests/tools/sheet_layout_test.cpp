#include "tools/sheet_layout.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

#include "core/marker_geometry.hpp"
#include "tools/id_list.hpp"

namespace roundel {

TEST_CASE("cells and ruler stay on the paper, whatever the diameter") {
  for (const char* paper : {"A4", "a3", "Letter"}) {
    for (int step = 0; step < 208; ++step) {
      const double diameter = 5 + 0.7 * step;
      const SheetLayout layout = lay_out_sheet(paper, diameter);
      CAPTURE(paper);
      CAPTURE(diameter);
      CHECK(layout.cell_mm == doctest::Approx(diameter * kMarginRatio));
      CHECK(layout.cells() >= 1);
      CHECK(layout.left_mm >= 5);
      CHECK(layout.top_mm >= 5);
      CHECK(layout.left_mm + layout.columns * layout.cell_mm <= layout.page.width_mm - 5);
      CHECK(layout.top_mm + layout.rows * layout.cell_mm <= layout.ruler_top_mm + 1e-6);
      // Filled: not one more column or row would fit.
      CHECK((layout.columns + 1) * layout.cell_mm > layout.page.width_mm - 14);
      CHECK((layout.rows + 1) * layout.cell_mm > layout.ruler_top_mm - 7);
    }
  }
}

TEST_CASE("the paper is turned where that takes more markers") {
  const SheetLayout small = lay_out_sheet("A4", 50);
  CHECK(small.page.width_mm == 210);
  CHECK(small.cells() == 12);
  const SheetLayout large = lay_out_sheet("A4", 106);  // two side by side on a landscape sheet
  CHECK(large.page.width_mm == 297);
  CHECK(large.cells() == 2);
}

TEST_CASE("a diameter that does not fit is refused with the largest that does") {
  CHECK_THROWS_WITH_AS(
      lay_out_sheet("A4", 160),
      "a marker of 0.16 m, 0.2055 m with its white margin, does not fit A4: at most 0.1526 m",
      std::invalid_argument);
  CHECK(lay_out_sheet("A4", 152.6).cells() == 1);
  CHECK_THROWS_AS(lay_out_sheet("A4", 152.7), std::invalid_argument);
  CHECK(lay_out_sheet("A3", 152.7).cells() == 2);
}

TEST_CASE("unknown paper is refused with the names that are known") {
  CHECK_THROWS_WITH_AS(paper_size("A5"), "paper \"A5\" is not known; use A4, A3, Letter or none",
                       std::invalid_argument);
}

TEST_CASE("id lists give the ids in the order written") {
  CHECK(parse_ids("7", 30) == std::vector{7});
  CHECK(parse_ids("1-4,9,20-22", 30) == std::vector{1, 2, 3, 4, 9, 20, 21, 22});
  CHECK(parse_ids("30,1", 30) == std::vector{30, 1});
}

TEST_CASE("id lists with ids that do not exist or that are no lists are refused") {
  for (const char* text : {"0", "31", "1-31", "-1", "99999999999"}) {
    CAPTURE(text);
    bool named = false;
    try {
      parse_ids(text, 30);
    } catch (const std::invalid_argument& error) {
      named = std::string(error.what()).find("this set has the ids 1 to 30") != std::string::npos;
    }
    CHECK(named);
  }
  for (const char* text : {"", "x", "1,", ",1", "1-", "1--2", "1-2-3", "1 2", "5-3", "1.5"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_ids(text, 30), std::invalid_argument);
  }
}

}  // namespace roundel
