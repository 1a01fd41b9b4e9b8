#include "tools/sheet_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/marker_geometry.hpp"

namespace roundel {
namespace {

constexpr double kEdgeMm = 7;    // what printers can't reach, and a little
constexpr double kStripMm = 19;  // ruler and text at the foot of the sheet

// Cells that fit into a length, forgiving rounding.
int count(double available_mm, double cell_mm) {
  return static_cast<int>(std::floor(available_mm / cell_mm + 1e-9));
}

// What cells have of a page: beside what printers can't reach and the strip.
PageSize room_on(PageSize page) {
  return {page.width_mm - 2 * kEdgeMm, page.height_mm - 2 * kEdgeMm - kStripMm};
}

SheetLayout lay_out(PageSize page, double cell_mm) {
  const PageSize room = room_on(page);
  return lay_out_grid(page, count(room.width_mm, cell_mm), count(room.height_mm, cell_mm), cell_mm);
}

}  // namespace

PageSize paper_size(const std::string& name) {
  std::string key = name;
  std::transform(key.begin(), key.end(), key.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (key == "a4") {
    return {210, 297};
  }
  if (key == "a3") {
    return {297, 420};
  }
  if (key == "letter") {
    return {8.5 * kMillimetresPerInch, 11 * kMillimetresPerInch};
  }
  throw std::invalid_argument(
      fmt::format("paper \"{}\" is not known; use A4, A3, Letter or none", name));
}

double largest_cell(PageSize page, int columns, int rows) {
  const PageSize room = room_on(page);
  return std::min(room.width_mm / columns, room.height_mm / rows);
}

SheetLayout lay_out_grid(PageSize page, int columns, int rows, double cell_mm) {
  const PageSize room = room_on(page);
  SheetLayout layout;
  layout.page = page;
  layout.cell_mm = cell_mm;
  layout.columns = columns;
  layout.rows = rows;
  layout.left_mm = kEdgeMm + (room.width_mm - columns * cell_mm) / 2;
  layout.top_mm = kEdgeMm + (room.height_mm - rows * cell_mm) / 2;
  layout.ruler_top_mm = page.height_mm - kEdgeMm - kStripMm;
  return layout;
}

SheetLayout lay_out_sheet(const std::string& paper, double diameter_mm) {
  const PageSize upright = paper_size(paper);
  const double cell_mm = diameter_mm * kMarginRatio;
  const SheetLayout portrait = lay_out(upright, cell_mm);
  const SheetLayout landscape = lay_out({upright.height_mm, upright.width_mm}, cell_mm);
  const SheetLayout& better = landscape.cells() > portrait.cells() ? landscape : portrait;
  if (better.cells() <= 0) {
    const double room = largest_cell(upright, 1, 1);
    throw std::invalid_argument(fmt::format(
        "a marker of {:.4g} m, {:.4g} m with its white margin, does not fit {}: at most {:.4g} m",
        diameter_mm / 1000, cell_mm / 1000, paper, std::floor(10 * room / kMarginRatio) / 10000));
  }
  return better;
}

}  // namespace roundel
