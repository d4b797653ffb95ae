#include "integrators/faltinsen_kinematics.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "groups/extended.h"
#include "integrators/faltinsen_bdf.h"
#include "problems/heavy_top.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/jets.h"
#include "tests/support/known_rotation.h"

namespace liebench::faltinsen_kinematics_test {
namespace {

// h (v of the kinematic equation - v(t_{n+1})) for the known rotation.
template <int k, bool exact>
double local_error(double step_size) {
  using S = HeavyTopSO3<Extended>;  // of which only the group counts here
  const Extended h(step_size);
  const KnownStep<k, S> step(h);
  FaltinsenKinematics<S, exact> kinematics(step.system, FaltinsenBdf::Options{.k = k});
  std::array<Configuration<S>, std::size_t(k - 1)> motions;
  for (int i = 1; i < k; ++i)
    motions[std::size_t(k - 1 - i)] = S::Group::exp(h * step.increments[std::size_t(i)]);
  kinematics.start(motions);
  EXPECT_TRUE(kinematics.defined(step.state));
  const auto v = kinematics.closure(step.state, step.affine).at(step.change).velocity;
  return to_double((h * (v - step.exact)).norm());
}

template <int k, bool exact>
void expect_slope() {
  const double slope = std::log2(local_error<k, exact>(0x1p-7) / local_error<k, exact>(0x1p-8));
  // As for BLieDF2nd: the next term of the error is below 10 times h.
  EXPECT_NEAR(slope, k + 1, 0.1) << k;
}

TEST(FaltinsenKinematics, LeavesALocalErrorOfOrderKPlusOne) {
  expect_slope<2, true>();
  expect_slope<3, true>();
  expect_slope<4, true>();
  expect_slope<3, false>();
  expect_slope<4, false>();
}

// h |v| up to 1; the sums end at 1e-4.
template <int k, bool exact>
void expect_linearization_is_the_derivative() {
  using S = HeavyTopSO3<double>;
  RandomNumbers random(3);
  const S system{HeavyTopParameters{}};
  BdfState<S> state{system, k};
  state.h = 0.1;
  state.velocity = 6 * random.vector<3>();
  state.increment = state.velocity + 0.1 * random.vector<3>();
  state.kappa = 0.01 * random.vector<3>();
  for (int i = 0; i < k - 1; ++i) {
    state.velocity_changes.push(0.3 * random.vector<3>());
    state.increment_changes.push(0.3 * random.vector<3>());
  }
  const double slope = state.coefficients.gamma[0];
  const AffineClosure<S> affine{.base_increment = state.increment,
                                .velocity = state.velocity,
                                .velocity_slope = slope,
                                .velocity_change = 0.3 * random.vector<3>(),
                                .acceleration_slope = slope * slope,
                                .scaled_acceleration = 0.3 * random.vector<3>()};
  FaltinsenKinematics<S, exact> kinematics(system, FaltinsenBdf::Options{.k = k});
  std::array<Configuration<S>, std::size_t(k - 1)> motions;
  Eigen::Vector3d Dq = state.increment;
  for (int i = 1; i < k; ++i) {
    motions[std::size_t(k - 1 - i)] = S::Group::exp(state.h * Dq);
    Dq -= state.increment_changes[i - 1];
  }
  kinematics.start(motions);
  const auto closure = kinematics.closure(state, affine);
  const Eigen::Vector3d d = 0.3 * random.vector<3>();
  const auto derivatives = closure.linearization(d);
  for (int j = 0; j < 3; ++j) {
    const auto along = [&](double s) { return closure.at(d + s * Eigen::Vector3d::Unit(j)); };
    const Eigen::Vector3d velocity =
        five_point_derivative<double>([&](double s) { return along(s).velocity; });
    const Eigen::Vector3d acceleration =
        five_point_derivative<double>([&](double s) { return along(s).scaled_acceleration; });
    EXPECT_LE((derivatives.velocity.col(j) - velocity).norm(), 1e-3 * slope) << k << ' ' << j;
    EXPECT_LE((derivatives.scaled_acceleration.col(j) - acceleration).norm(), 1e-3 * slope * slope)
        << k << ' ' << j;
  }
}

TEST(FaltinsenKinematics, LinearizationIsTheDerivative) {
  expect_linearization_is_the_derivative<2, true>();
  expect_linearization_is_the_derivative<3, true>();
  expect_linearization_is_the_derivative<4, true>();
  expect_linearization_is_the_derivative<3, false>();
  expect_linearization_is_the_derivative<4, false>();
}

}  // namespace
}  // namespace liebench::faltinsen_kinematics_test
