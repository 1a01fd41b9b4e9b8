#include "tools/board_sheet.hpp"

#include <doctest/doctest.h>

#include <string>

#include "calibration/board_detector.hpp"
#include "calibration/intrinsic_start.hpp"
#include "daemon/image_file.hpp"
#include "tests/error_of.hpp"
#include "tests/tools/run_roundel.hpp"

namespace roundel {
namespace {

constexpr double kPixelsPerMm = 100 / kMillimetresPerInch;

// A camera that looks at the page squarely.
CameraModel scanner(const GreyImage& page) {
  CameraModel camera = guessed_camera(page.width, page.height);
  camera.fx = camera.fy = 10 * page.width;
  return camera;
}

}  // namespace

TEST_CASE("the usual board fills each paper") {
  const auto spacing = [](const std::string& paper) { return largest_board(paper, {}).spacing_m; };
  CHECK(spacing("A4") == doctest::Approx(0.040));
  CHECK(spacing("A3") == doctest::Approx(0.058));
  CHECK(spacing("Letter") == doctest::Approx(0.037));
  CHECK(largest_board("A3", {}).diameter_m == doctest::Approx(0.75 * 0.058));
  for (const char* paper : {"A4", "A3", "Letter"}) {
    const SheetLayout layout = lay_out_board(paper, largest_board(paper, {}));
    CHECK(layout.page.width_mm > layout.page.height_mm);  // 7 x 4 lies across
    CHECK(layout.left_mm >= 7);
    CHECK(layout.top_mm >= 7);
    CHECK(layout.top_mm + layout.rows * layout.cell_mm <= layout.ruler_top_mm + 1e-9);
  }
}

TEST_CASE("a board that does not fit its paper is refused with what would") {
  Board board;
  board.spacing_m = 0.05;
  CHECK(error_of([&] { lay_out_board("A4", board); }) ==
        "7 x 4 markers at a spacing of 0.05 m do not fit A4: at most 0.0404 m");
  CHECK(error_of([&] { lay_out_board("A3", board); }) == "");
  board.columns = 50;
  CHECK(error_of([&] { largest_board("A4", board); }).find("too many for A4") != std::string::npos);
}

TEST_CASE("a printed board's markers lie where a calibration thinks that they lie") {
  const TemporaryDirectory directory;
  struct Print {
    std::string options;
    Board board;
  };
  Board fine;
  fine.columns = 9;
  fine.rows = 6;
  fine.bits = 10;
  fine.spacing_m = 0.025;
  fine.diameter_m = 0.018;
  const std::vector<Print> prints = {
      {"", {}}, {"--columns 9 --rows 6 --bits 10 --spacing 0.025 --diameter 0.018", fine}};
  for (const Print& print : prints) {
    CAPTURE(print.options);
    const CommandResult result = run_roundel("markers --board --dpi 100 " + print.options + " -o " +
                                             directory.file("board.png"));
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    const GreyImage page = load_image(directory.file("board.png"));
    BoardDetector detector(print.board, scanner(page));
    const BoardSighting seen = detector.find(page.view());
    REQUIRE(seen.view.points.size() == static_cast<std::size_t>(print.board.count()));
    CHECK(seen.foreign == 0);  // nothing else on the sheet looks like a marker
    Eigen::Vector2d middle(0, 0);
    for (const BoardPoint& point : seen.view.points) middle += point.pixel;
    middle /= static_cast<double>(seen.view.points.size());
    CHECK(middle.x() == doctest::Approx(0.5 * (page.width - 1)).epsilon(0.002));
    for (const BoardPoint& point : seen.view.points) {
      const Eigen::Vector2d mm = 1000 * print.board.centre_of(point.id);
      const Eigen::Vector2d expected = middle + kPixelsPerMm * Eigen::Vector2d(mm.x(), -mm.y());
      CHECK((point.pixel - expected).norm() < 0.03);
    }
  }
}

TEST_CASE("the sheet tells the command that calibrates with it") {
  const TemporaryDirectory directory;
  REQUIRE(run_roundel("markers --board --paper A3 -o " + directory.file("b.pdf")).status == 0);
  const CommandResult text = run_command("pdftotext -layout " + directory.file("b.pdf") + " -");
  REQUIRE_MESSAGE(text.status == 0, "poppler-utils is needed: ", text.err);
  CHECK(contains(text.out,
                 "roundel calibrate camera --columns 7 --rows 4 --spacing 0.058 --bits 8 -o"));
}

TEST_CASE("board options that make no sense are refused") {
  check_refused("markers --board", 2, "--output is required");
  check_refused("markers --board --id 3 -o b.pdf", 2, "Exactly 1 option");
  check_refused("markers --id 3 --columns 3 -o b.pdf", 2, "--board");
  check_refused("markers --board --columns 8 -o b.pdf", 2, "use more --bits");
  check_refused("markers --board --paper none -o b.pdf", 2, "a board needs a sheet");
  check_refused("markers --board --spacing 0.06 -o b.pdf", 2, "at most 0.0404 m");
  check_refused("markers --board --diameter 0.039 -o b.pdf", 2, "no white margin");
  check_refused("markers --board --columns 0 -o b.pdf", 2, "a board has at least 2 columns");
  check_refused("markers --board --paper B5 -o b.pdf", 2, "paper \"B5\" is not known");
  check_refused("markers --board -o b.gif", 2, "names no known format");
}

}  // namespace roundel
