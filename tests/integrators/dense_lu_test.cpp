#include "integrators/dense_lu.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <random>
#include <utility>

#include "groups/extended.h"
#include "tests/support/dense_algebra.h"

namespace liebench::dense_lu_test {
namespace {

// Numbers in [-1, 1).
class Numbers {
 public:
  double operator()() { return double(engine_()) / 2147483648.0 - 1.0; }

 private:
  std::mt19937 engine_{31};
};

// Calls f.template operator()<n>() for n = 1, 2, 3, 6, 9, 12: odd and even, those of the heavy top among them.
template <class F>
void for_every_size(const F& f) {
  [&]<int... n>(std::integer_sequence<int, n...>) {
    (f.template operator()<n>(), ...);
  }
  (std::integer_sequence<int, 1, 2, 3, 6, 9, 12>{});
}

template <class T, int n>
typename DenseLu<T, n>::Matrix random_matrix(Numbers& numbers) {
  typename DenseLu<T, n>::Matrix A;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) A(i, j) = T(numbers());
  return A;
}

// Gaussian elimination with partial pivoting: |A x - b| <= 3 n^2 growth eps |A| |x| [Higham 2002, theorem
// 9.5], the growth below ten for random matrices of this size.
template <class T, int n>
double backward_error_bound(const typename DenseLu<T, n>::Matrix& A, const Eigen::Matrix<T, n, 1>& x) {
  return 30.0 * n * n * to_double(Eigen::NumTraits<T>::epsilon()) * to_double(A.norm()) * to_double(x.norm());
}

TEST(DenseLu, SolvesRandomSystemsAsEigenDoes) {
  Numbers numbers;
  for_every_size([&]<int n>() {
    for (int repetition = 0; repetition < 20; ++repetition) {
      const auto A = random_matrix<double, n>(numbers);
      Eigen::Matrix<double, n, 1> b;
      for (int i = 0; i < n; ++i) b(i) = numbers();
      DenseLu<double, n> lu;
      ASSERT_TRUE(lu.factorize(A));
      const Eigen::Matrix<double, n, 1> x = lu.solve(b);
      EXPECT_LE((A * x - b).norm(), (backward_error_bound<double, n>(A, x))) << n;
      const Eigen::MatrixXd dense = A;
      const Eigen::VectorXd expected = dense_solution(dense, b);
      const double condition = dense_condition(dense);
      EXPECT_LE((x - expected).norm(), condition * 60 * n * n * 2.3e-16 * x.norm()) << n;
    }
  });
}

TEST(DenseLu, SolvesInExtendedPrecision) {
  Numbers numbers;
  const auto check = [&]<int n>() {
    const auto A = random_matrix<Extended, n>(numbers);
    Eigen::Matrix<Extended, n, 1> b;
    for (int i = 0; i < n; ++i) b(i) = Extended(numbers()) / 3.0;
    DenseLu<Extended, n> lu;
    ASSERT_TRUE(lu.factorize(A));
    const Eigen::Matrix<Extended, n, 1> x = lu.solve(b);
    const Eigen::Matrix<Extended, n, 1> residual = A.lazyProduct(x) - b;
    EXPECT_LE(to_double(residual.norm()), (backward_error_bound<Extended, n>(A, x))) << n;
  };
  check.operator()<1>();
  check.operator()<2>();
  check.operator()<9>();
}

TEST(DenseLu, SolvesPermutationsExactly) {
  // The cyclic shift has no usable pivot on its diagonal.
  for_every_size([]<int n>() {
    typename DenseLu<double, n>::Matrix A;
    A.setZero();
    Eigen::Matrix<double, n, 1> b, expected;
    for (int i = 0; i < n; ++i) {
      A(i, (i + 1) % n) = 2;
      b(i) = i + 1;
      expected((i + 1) % n) = 0.5 * (i + 1);
    }
    DenseLu<double, n> lu;
    ASSERT_TRUE(lu.factorize(A));
    EXPECT_EQ(lu.solve(b), expected) << n;
  });
}

TEST(DenseLu, PivotsForStability) {
  // Without pivoting the tiny diagonal entry destroys the solution (1, 1).
  DenseLu<double, 2>::Matrix A;
  A << 1e-20, 1, 1, 1;
  DenseLu<double, 2> lu;
  ASSERT_TRUE(lu.factorize(A));
  EXPECT_LE((lu.solve(Eigen::Vector2d(1, 2)) - Eigen::Vector2d(1, 1)).norm(), 1e-15);
}

TEST(DenseLu, RefusesSingularMatrices) {
  Numbers numbers;
  for_every_size([&]<int n>() {
    DenseLu<double, n> lu;
    auto A = random_matrix<double, n>(numbers);
    A.col(n / 2).setZero();
    EXPECT_FALSE(lu.factorize(A)) << n;
    if constexpr (n > 1) {
      // Two equal rows (the same constraint twice) stay equal in every operation, until one of them
      // eliminates the other: the factor is the quotient of two equal numbers, which is 1 exactly.
      for (int repetition = 0; repetition < 50; ++repetition) {
        A = random_matrix<double, n>(numbers);
        A.row(n - 1) = A.row(0);
        EXPECT_FALSE(lu.factorize(A)) << n;
      }
    }
  });
}

TEST(DenseLu, RefusesMatricesThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    DenseLu<double, 1> one;
    DenseLu<double, 1>::Matrix a;
    a << bad;
    EXPECT_FALSE(one.factorize(a)) << bad;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        DenseLu<double, 3>::Matrix A;
        A << 4, 1, 2, 1, 5, 3, 2, 3, 6;
        A(i, j) = bad;
        DenseLu<double, 3> lu;
        EXPECT_FALSE(lu.factorize(A)) << bad << ' ' << i << ' ' << j;
      }
  }
}

TEST(DenseLu, ServesManyRightHandSides) {
  Numbers numbers;
  const auto A = random_matrix<double, 9>(numbers);
  DenseLu<double, 9> lu;
  ASSERT_TRUE(lu.factorize(A));
  for (int i = 0; i < 9; ++i) {
    const Eigen::Matrix<double, 9, 1> x = lu.solve(A.col(i));
    EXPECT_LE((x - Eigen::Matrix<double, 9, 1>::Unit(i)).norm(), 1e-12) << i;  // condition below 1e3
  }
}

}  // namespace
}  // namespace liebench::dense_lu_test
