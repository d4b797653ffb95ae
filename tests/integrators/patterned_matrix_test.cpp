#include "integrators/patterned_matrix.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/dense_algebra.h"

namespace liebench::patterned_matrix_test {
namespace {

// Regular, with zeros, and with pivots away from the diagonal.
Eigen::MatrixXd sample(Eigen::Index n) {
  Eigen::MatrixXd A(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      A(i, j) = (i + j) % 3 == 0 && i != (j + 1) % n ? 0.0 : std::sin(1.0 + double(7 * i + 3 * j * j));
  for (Eigen::Index j = 0; j < n; ++j) A((j + 1) % n, j) += 3.0;
  return A;
}

// Of the sizes with code of their own, others, and sparse ones.
TEST(PatternedMatrix, SolvesWhatTheDenseFactorizationSolves) {
  for (Eigen::Index n : {1, 2, 5, 6, 7, 9, 12, 13, 18, 22, 27, 48, 49, 60}) {
    const Eigen::MatrixXd A = sample(n);
    PatternedMatrix<double> matrix(n);
    for (int pass = 0; pass < 2; ++pass) {  // with a pattern to find, and with a known one
      matrix.begin();
      matrix.add_block(0, 0, A.leftCols(n / 2));
      matrix.add_block(0, n / 2, A.rightCols(n - n / 2));
      ASSERT_TRUE(matrix.factorize()) << n;
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1.0, 2.0);
      const Eigen::VectorXd expected = dense_solution(A, b);
      // Round-off times the condition, which is below 1e3.
      const double tolerance = 1e-12 * (1.0 + expected.norm());
      Eigen::VectorXd x(n), first((n + 1) / 2), in_place = b;
      matrix.solve(b, x);
      EXPECT_LE((x - expected).norm(), tolerance) << n;
      matrix.solve(b, first);
      EXPECT_EQ(first, x.head(first.size())) << n;
      matrix.solve(in_place, in_place);
      EXPECT_EQ(in_place, x) << n;
    }
  }
}

TEST(PatternedMatrix, ASingularMatrixIsNotFactorized) {
  for (Eigen::Index n : {3, 6, 9, 12, 18, 27, 49}) {
    Eigen::MatrixXd A = sample(n);
    A.row(n - 1) = A.row(0);
    PatternedMatrix<double> matrix(n);
    matrix.begin();
    matrix.add_block(0, 0, A);
    EXPECT_FALSE(matrix.factorize()) << n;
    EXPECT_TRUE(matrix.finite()) << n;
  }
}

}  // namespace
}  // namespace liebench::patterned_matrix_test
