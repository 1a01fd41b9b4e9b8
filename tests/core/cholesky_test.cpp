#include "core/cholesky.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

using namespace roundel;

namespace {

constexpr int kCount = 7;
using Matrix = Eigen::Matrix<double, kCount, kCount>;
using Vector = Eigen::Matrix<double, kCount, 1>;

// Positive definite, and with nothing regular about it.
Matrix some_matrix() {
  Matrix root;
  for (int i = 0; i < kCount; ++i) {
    for (int k = 0; k < kCount; ++k) root(i, k) = std::sin(1.7 * i + 2.9 * k * k + 0.3);
  }
  return root * root.transpose() + 0.1 * Matrix::Identity();
}

}  // namespace

TEST_CASE("Cholesky's solution solves the equations, from the lower triangle alone") {
  const Matrix matrix = some_matrix();
  Vector wanted;
  for (int i = 0; i < kCount; ++i) wanted[i] = 1.0 / (i + 1) - 0.4;
  Matrix lower = matrix.triangularView<Eigen::Lower>();
  lower(0, kCount - 1) = 1e9;
  CHECK((Cholesky<kCount>(lower).solve(matrix * wanted) - wanted).norm() < 1e-9);
}

TEST_CASE("the first unknowns' part of the inverse is that of the whole inverse") {
  const Matrix matrix = some_matrix();
  const Matrix inverse = matrix.inverse();
  const auto first = Cholesky<kCount>(matrix).inverse_of_first<4>();
  CHECK((first - inverse.topLeftCorner<4, 4>()).norm() < 1e-9 * inverse.norm());
}

TEST_CASE("a matrix that is not positive definite has no finite solution") {
  Matrix matrix = some_matrix();
  matrix(2, 2) = -1;
  CHECK_FALSE(Cholesky<kCount>(matrix).solve(Vector::Ones()).allFinite());
}
