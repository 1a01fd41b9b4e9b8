#pragma once

#include <Eigen/Core>
#include <cmath>

namespace roundel {

// Cholesky's decomposition of small symmetric matrices, without pivots: the matrix is upper^T *
// diagonal * upper taken from its last row to the first, so that what belongs to the first unknowns
// can be inverted by itself. Not positive definite ones give results that are not finite.
template <int kCount>
class Cholesky {
 public:
  using Matrix = Eigen::Matrix<double, kCount, kCount>;
  using Vector = Eigen::Matrix<double, kCount, 1>;

  // Only the lower triangle is read.
  explicit Cholesky(const Matrix& matrix) {
    for (int i = kCount - 1; i >= 0; --i) {
      for (int k = 0; k <= i; ++k) row_[i][k] = matrix(i, k);
      for (int j = i + 1; j < kCount; ++j) {
        const double factor = row_[j][i];
        for (int k = 0; k <= i; ++k) row_[i][k] -= factor * row_[j][k];
      }
      const double root = std::sqrt(row_[i][i]);
      per_root_[i] = 1 / root;
      for (int k = 0; k <= i; ++k) row_[i][k] *= per_root_[i];
    }
  }

  // The x of matrix * x = right_side.
  Vector solve(const Vector& right_side) const {
    Vector x = right_side;
    for (int i = kCount - 1; i >= 0; --i) {
      x[i] *= per_root_[i];
      for (int k = 0; k < i; ++k) x[k] -= row_[i][k] * x[i];
    }
    for (int i = 0; i < kCount; ++i) {
      for (int k = 0; k < i; ++k) x[i] -= row_[i][k] * x[k];
      x[i] *= per_root_[i];
    }
    return x;
  }

  // The first unknowns' rows and columns of the inverse.
  template <int kFirst>
  Eigen::Matrix<double, kFirst, kFirst> inverse_of_first() const {
    // The inverse of the factor's first rows, which is a lower triangle as well.
    double inverse[kFirst][kFirst] = {};
    for (int i = 0; i < kFirst; ++i) {
      inverse[i][i] = per_root_[i];
      for (int j = 0; j < i; ++j) {
        double sum = 0;
        for (int k = j; k < i; ++k) sum += row_[i][k] * inverse[k][j];
        inverse[i][j] = -sum * per_root_[i];
      }
    }
    Eigen::Matrix<double, kFirst, kFirst> product;
    for (int i = 0; i < kFirst; ++i) {
      for (int j = 0; j <= i; ++j) {
        double sum = 0;
        for (int k = 0; k <= j; ++k) sum += inverse[i][k] * inverse[j][k];
        product(i, j) = product(j, i) = sum;
      }
    }
    return product;
  }

 private:
  double row_[kCount][kCount] = {};  // of the factor, lower triangle
  double per_root_[kCount] = {};     // of its diagonal
};

}  // namespace roundel
