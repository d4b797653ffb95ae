#include <benchmark/benchmark.h>

#include <Eigen/LU>

#include "groups/so3.h"
#include "integrators/dense_lu.h"

// The pieces of a step: exponential, tangent operator, factorization and back-substitution of the constrained
// top's size.

namespace {

using namespace liebench;

void so3_exp(benchmark::State& state) {
  Eigen::Vector3d v(0.001, 0.015, -0.002);
  for (auto _ : state) {
    benchmark::DoNotOptimize(v);
    benchmark::DoNotOptimize(SO3<double>::exp(v));
  }
}
BENCHMARK(so3_exp);

void so3_tangent(benchmark::State& state) {
  Eigen::Vector3d v(0.001, 0.015, -0.002);
  for (auto _ : state) {
    benchmark::DoNotOptimize(v);
    benchmark::DoNotOptimize(SO3<double>::tangent(v));
  }
}
BENCHMARK(so3_tangent);

Eigen::Matrix<double, 9, 9> example() {
  Eigen::Matrix<double, 9, 9> A;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) A(i, j) = 1.0 / (i + j + 1.0) + (i == j ? 3.0 : 0.0);
  return A;
}

void dense_lu(benchmark::State& state) {
  DenseLu<double, 9>::Matrix A = example();
  DenseLu<double, 9> lu;
  for (auto _ : state) {
    benchmark::DoNotOptimize(A);
    benchmark::DoNotOptimize(lu.factorize(A));
  }
}
BENCHMARK(dense_lu);

void dense_lu_solve(benchmark::State& state) {
  DenseLu<double, 9> lu;
  lu.factorize(example());
  Eigen::Matrix<double, 9, 1> b = Eigen::Matrix<double, 9, 1>::Ones();
  for (auto _ : state) {
    benchmark::DoNotOptimize(b);
    benchmark::DoNotOptimize(lu.solve(b));
  }
}
BENCHMARK(dense_lu_solve);

void eigen_partial_piv_lu(benchmark::State& state) {
  Eigen::Matrix<double, 9, 9> A = example();
  for (auto _ : state) {
    benchmark::DoNotOptimize(A);
    benchmark::DoNotOptimize(Eigen::PartialPivLU<Eigen::Matrix<double, 9, 9>>(A).matrixLU());
  }
}
BENCHMARK(eigen_partial_piv_lu);

}  // namespace
