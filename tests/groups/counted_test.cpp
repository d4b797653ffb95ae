#include "groups/counted.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "groups/so3.h"

namespace liebench::counted_test {
namespace {

template <class Work>
Operations operations_of(const Work& work) {
  const Operations before = Counted::operations();
  work();
  return Counted::operations() - before;
}

TEST(Counted, CountsEachKindOfOperation) {
  const Counted a = 3.0, b = 4.0;
  double value = 0.0;
  const Operations count = operations_of([&] {
    const Counted root = sqrt(a * a + b * b);
    value = to_double(root / 2.0 - sin(Counted(0.0)));
  });
  EXPECT_EQ(value, 2.5);
  EXPECT_EQ(count.multiply, 2u);
  EXPECT_EQ(count.add, 2u);  // a sum and a difference
  EXPECT_EQ(count.divide, 1u);
  EXPECT_EQ(count.square_root, 1u);
  EXPECT_EQ(count.transcendental, 1u);
  EXPECT_EQ(count.total(), 7u);
}

TEST(Counted, ChangesOfSignCopiesAndComparisonsAreFree) {
  const Counted a = 3.0, b = -a;
  EXPECT_EQ(operations_of([&] {
              const Counted c = -b;
              EXPECT_TRUE(c == a && b < a && abs(b) >= a);
            }).total(),
            0u);
}

TEST(Counted, AMatrixProductTakesWhatItsDefinitionSays) {
  using Matrix = Eigen::Matrix<Counted, 3, 3>;
  const Matrix A = Matrix::Constant(2.0), B = Matrix::Constant(3.0);
  Matrix C;
  const Operations count = operations_of([&] { C.noalias() = A.lazyProduct(B); });
  EXPECT_EQ(C(1, 2).value(), 18.0);
  EXPECT_EQ(count.multiply, 27u);
  EXPECT_EQ(count.add, 18u);
}

TEST(Counted, GivesTheNumbersOfDouble) {
  const Eigen::Vector3d v(0.3, -1.1, 0.7);
  const auto counted = SO3<Counted>::exp(v.cast<Counted>());
  const Eigen::Matrix3d R = SO3<double>::exp(v);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(counted(i).value(), R(i));
}

}  // namespace
}  // namespace liebench::counted_test
