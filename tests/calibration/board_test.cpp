#include "calibration/board.hpp"

#include <doctest/doctest.h>

#include "calibration/print_quality.hpp"
#include "tests/error_of.hpp"

using namespace roundel;

TEST_CASE("a board's ids rise row by row from the top left, around the middle") {
  const Board board;  // 7 x 4, 40 mm
  CHECK((board.centre_of(1) - Eigen::Vector2d(-0.12, 0.06)).norm() < 1e-12);
  CHECK((board.centre_of(7) - Eigen::Vector2d(0.12, 0.06)).norm() < 1e-12);
  CHECK((board.centre_of(8) - Eigen::Vector2d(-0.12, 0.02)).norm() < 1e-12);
  CHECK((board.centre_of(28) - Eigen::Vector2d(0.12, -0.06)).norm() < 1e-12);
  CHECK(board.has(28));
  CHECK_FALSE(board.has(29));
  CHECK_FALSE(board.has(0));
}

TEST_CASE("a board that can't be is refused with what would be right") {
  const auto error = [](auto&& change) {
    Board board;
    change(board);
    return error_of([&] { checked(board); });
  };
  CHECK(error([](Board&) {}) == "");
  CHECK(error([](Board& b) { b.columns = 8; }) ==
        "a board of 8 x 4 needs 32 ids, but the set of 8 bits has 30: use more --bits, or fewer "
        "--columns or --rows");
  CHECK(
      error([](Board& b) { b.rows = 1; }).starts_with("a board has at least 2 columns and 2 rows"));
  CHECK(error([](Board& b) { b.columns = b.rows = 2; }).find("6 to 200 markers") !=
        std::string::npos);
  CHECK(error([](Board& b) { b.columns = b.rows = 2147483647; }).find("6 to 200") !=
        std::string::npos);
  CHECK(error([](Board& b) { b.columns = -7; }).find("not -7 x 4") != std::string::npos);
  CHECK(error([](Board& b) { b.diameter_m = 0.036; }).find("at most 0.0332 m") !=
        std::string::npos);
  CHECK(error([](Board& b) { b.diameter_m = 0; }).find("must be positive") != std::string::npos);
  CHECK(error([](Board& b) { b.bits = 99; }) != "");
}

TEST_CASE("what is wrong with a print is told from its offsets, whatever frame they are in") {
  const Board board;
  std::vector<Eigen::Vector3d> offsets;
  for (int id = 1; id <= board.count(); ++id) {
    const Eigen::Vector2d at = board.centre_of(id);
    // 0.2 % longer along y; a bow of 1 mm along x; shifted, turned, tilted and scaled besides.
    Eigen::Vector3d offset(0.003 * at.x() - 0.01 * at.y() + 0.001,
                           0.005 * at.y() + 0.01 * at.x() - 0.002,
                           0.02 * at.x() - 0.03 * at.y() + 0.004);
    offset.z() += 0.001 * (1 - at.x() * at.x() / (0.12 * 0.12));
    offsets.push_back(offset);
  }
  const PrintQuality quality = print_quality(board, offsets);
  CHECK(quality.stretch == doctest::Approx(0.002));
  CHECK(quality.flatness_m == doctest::Approx(0.001));
  // The stretch moves markers by 0.1 % of their place to either side.
  double squares = 0;
  for (int id = 1; id <= board.count(); ++id) squares += board.centre_of(id).squaredNorm();
  CHECK(quality.off_m == doctest::Approx(0.001 * std::sqrt(squares / board.count())));
  CHECK(print_quality(board, {}).flatness_m == 0);
}
