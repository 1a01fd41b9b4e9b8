#pragma once

#include <string>
#include <vector>

#include "tools/page_output.hpp"

namespace roundel {

// A sheet of paper and how square cells of one marker each (with its white margin) fill it.
struct SheetLayout {
  PageSize page;              // as the sheet is held: portrait or landscape, whichever takes more
  double cell_mm = 0;         // side of a cell: the diameter of the white margin
  int columns = 0, rows = 0;  // of cells on the sheet, at least 1
  double left_mm = 0, top_mm = 0;  // of the first cell
  double ruler_top_mm = 0;         // where the strip with ruler and text begins, below the cells

  int cells() const { return columns * rows; }
};

// A4, A3, Letter (any case), upright; std::invalid_argument that lists the names for others.
PageSize paper_size(const std::string& name);

// Side of the largest cells of which so many fit the page beside the strip, mm.
double largest_cell(PageSize page, int columns, int rows);

// So many cells in the middle of the page. They must fit.
SheetLayout lay_out_grid(PageSize page, int columns, int rows, double cell_mm);

// Throws std::invalid_argument, with the largest diameter that would do, where not one marker of
// this outer black diameter fits the paper.
SheetLayout lay_out_sheet(const std::string& paper, double diameter_mm);

}  // namespace roundel
