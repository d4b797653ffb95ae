#include "integrators/centred_kinematics.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "groups/extended.h"
#include "integrators/centred_bdf.h"
#include "problems/heavy_top.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/jets.h"
#include "tests/support/known_rotation.h"

namespace liebench::centred_kinematics_test {
namespace {

constexpr int most_steps = 6;

// h (v of the kinematic equation - v(t_{n+1})) for the known rotation.
template <int k>
double local_error(double step_size) {
  using S = HeavyTopSO3<Extended>;  // of which only the group counts here
  const Extended h(step_size);
  const KnownStep<k, S> step(h);
  CentredKinematics<S> kinematics(step.system, CentredBdf::Options{.k = k});
  std::array<Configuration<S>, std::size_t(k - 1)> motions;
  for (int i = 1; i < k; ++i)
    motions[std::size_t(k - 1 - i)] = S::Group::exp(h * step.increments[std::size_t(i)]);
  kinematics.start(motions);
  EXPECT_TRUE(kinematics.defined(step.state));
  const auto v = kinematics.closure(step.state, step.affine).at(step.change).velocity;
  return to_double((h * (v - step.exact)).norm());
}

template <int k>
void expect_slope() {
  const double slope = std::log2(local_error<k>(0x1p-7) / local_error<k>(0x1p-8));
  // As for BLieDF2nd: the next term of the error is below 10 times h.
  EXPECT_NEAR(slope, k + 1, 0.1) << k;
}

TEST(CentredKinematics, LeavesALocalErrorOfOrderKPlusOne) {
  expect_slope<2>();
  expect_slope<3>();
  expect_slope<4>();
  expect_slope<5>();
  expect_slope<6>();
}

// A step of some motion that turns by h |v| = 0.45 a step at most.
template <class T>
struct SomeStep {
  using S = HeavyTopSO3<T>;
  using Group = typename S::Group;
  using Vector = Velocity<S>;
  S system{HeavyTopParameters{}};
  BdfState<S> state;
  AffineClosure<S> affine;
  CentredKinematics<S> kinematics;
  std::vector<Vector> increments;  // Dq_{n-1}, Dq_{n-2}, ...

  explicit SomeStep(int k) : state(system, k), kinematics(system, CentredBdf::Options{.k = k}) {
    RandomNumbers random(3);
    const auto vector = [&](double size) {
      return (size * random.vector<3>()).eval().template cast<T>().eval();
    };
    state.h = T(0.1);
    state.velocity = vector(2.5);
    state.increment = state.velocity + vector(0.1);
    increments.push_back(state.increment);
    for (int i = 0; i < k - 1; ++i) {
      state.velocity_changes.push(vector(0.1));
      state.increment_changes.push(vector(0.1));
    }
    for (int i = 1; i < k; ++i) increments.push_back(increments.back() - state.increment_changes[i - 1]);
    const T slope = state.coefficients.gamma[0];
    affine = {.base_increment = state.increment,
              .velocity = state.velocity,
              .velocity_slope = slope,
              .velocity_change = vector(0.3),
              .acceleration_slope = slope * slope,
              .scaled_acceleration = vector(0.3)};
    for (int i = k - 1; i >= 1; --i) kinematics.accept(Group::exp(state.h * increments[std::size_t(i - 1)]));
  }

  // (1/h) sum alpha_i log(q_{n+1}^{-1} q_{n+1-i}), q_{n+1-i} by products of inverse motions.
  Vector velocity(const Vector& d) const {
    typename Group::Element back = Group::exp(-state.h * (state.increment + d));
    Vector sum = Vector::Constant(T(0.0));
    for (int i = 1; i <= state.k; ++i) {
      sum += state.coefficients.alpha[std::size_t(i)] * Group::log(back);
      back = Group::compose(back, Group::exp(-state.h * increments[std::size_t(i - 1)]));
    }
    return sum / state.h;
  }
};

template <class T>
void expect_values_of_the_equation() {
  RandomNumbers random(5);
  const double unit = to_double(Eigen::NumTraits<T>::epsilon());
  for (int k = 2; k <= most_steps; ++k) {
    const SomeStep<T> step(k);
    ASSERT_TRUE(step.kinematics.defined(step.state));
    const auto closure = step.kinematics.closure(step.state, step.affine);
    const auto predicted = step.state.predicted_change();
    // At the prediction, next to it and far away.
    for (const double distance : {0.0, unit, 1e-16, 1e-8, 1e-7, 1e-4, 0.1, 0.5}) {
      const auto d = (predicted + (distance * random.vector<3>()).eval().template cast<T>()).eval();
      const auto values = closure.at(d);
      // Products of up to six rotations and their logarithms: 2 eps each, times alpha_i / h, together 60 / h (k = 6);
      // and the derivative's rest, eps / 12 of each.
      const double tolerance = 16 * 60 * unit / 0.1;
      const auto expected = step.velocity(d);
      EXPECT_LE(to_double((values.velocity - expected).norm()), tolerance) << k << ' ' << distance;
      EXPECT_LE(to_double((values.velocity - step.state.velocity - values.velocity_change).norm()), 8 * unit)
          << k << ' ' << distance;
      // h v' of the method: v_{n+1} - v_n times gamma_1 beyond what it is for the affine part.
      const auto slope = step.affine.velocity_slope;
      const auto acceleration = (step.affine.scaled_acceleration +
                                 slope * (expected - step.state.velocity - step.affine.velocity_change))
                                    .eval();
      EXPECT_LE(to_double((values.scaled_acceleration - acceleration).norm()), 4 * tolerance)
          << k << ' ' << distance;
    }
  }
}

TEST(CentredKinematics, ValuesAreThoseOfTheLogarithmsNearThePredictionAndFarFromIt) {
  expect_values_of_the_equation<double>();
  expect_values_of_the_equation<Extended>();
}

TEST(CentredKinematics, LinearizationIsTheDerivative) {
  RandomNumbers random(7);
  for (int k = 2; k <= most_steps; ++k) {
    const SomeStep<double> step(k);
    const auto closure = step.kinematics.closure(step.state, step.affine);
    const Eigen::Vector3d d = step.state.predicted_change() + 0.3 * random.vector<3>();
    const auto derivatives = closure.linearization(d);
    const double slope = step.affine.velocity_slope;
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d velocity = five_point_derivative<double>(
          [&](double s) { return step.velocity(d + s * Eigen::Vector3d::Unit(j)); });
      // Of the stencil: eps^(4/5) = 3e-13 in units of 1, and v is some 60 / h times the logarithms (k = 6), which are.
      EXPECT_LE((derivatives.velocity.col(j) - velocity).norm(), 600 * 3e-13) << k << ' ' << j;
      EXPECT_LE((derivatives.scaled_acceleration.col(j) - slope * velocity).norm(), 600 * 3e-13 * slope)
          << k << ' ' << j;
    }
  }
}

TEST(CentredKinematics, AChangeOfTheIncrementBySomeUnitsChangesTheVelocityByAsMany) {
  // Logarithms alone would change by units of their own last place: eps |v| alpha_i, here 1e-14.
  RandomNumbers random(11);
  for (int k = 2; k <= most_steps; ++k) {
    const SomeStep<double> step(k);
    const auto closure = step.kinematics.closure(step.state, step.affine);
    for (const double distance : {0.0, 1e-6, 1e-3}) {
      const Eigen::Vector3d d = step.state.predicted_change() + distance * Eigen::Vector3d(0.7, -0.4, 0.3);
      const auto at_d = closure.at(d);
      const auto J = closure.linearization(d).velocity;
      int equal = 0;
      constexpr int tries = 32;
      for (int i = 0; i < tries; ++i) {
        const Eigen::Vector3d moved = d + 1e-14 * random.vector<3>();
        const auto values = closure.at(moved);
        const Eigen::Vector3d change = values.velocity_change - at_d.velocity_change;
        // The sums are of the size of |d| + |v_{n+1} - v_n|, below 2.
        if ((change - J * (moved - d)).norm() <= 4 * 2.2e-16 * 2) ++equal;
      }
      // All but those with which d to half of its digits changes its last: some 1e-14 / (1e-7 distance).
      EXPECT_GE(equal, tries - 2) << k << ' ' << distance;
    }
  }
}

}  // namespace
}  // namespace liebench::centred_kinematics_test
