#include "integrators/lie_correction.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "groups/extended.h"
#include "integrators/bliedf2nd.h"
#include "problems/heavy_top.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/jets.h"
#include "tests/support/known_rotation.h"

namespace liebench::lie_correction_test {
namespace {

using S = HeavyTopSO3<Extended>;  // of which only the group counts here
using Vector = KnownRotation::Vector;

// Calls f.template operator()<k>() for k = least, ..., 6.
template <int least, class F>
void for_every_k(const F& f) {
  [&]<int... i>(std::integer_sequence<int, i...>) {
    (f.template operator()<least + i>(), ...);
  }
  (std::make_integer_sequence<int, 7 - least>{});
}

// h (v of the kinematic equation - v(t_{n+1})) for the known rotation: corrected, without the correction, and with one of
// the wrong sign.
struct LocalErrors {
  Vector corrected, uncorrected, wrong_sign;
};

template <int k, class Kinematics>
LocalErrors local_errors(Correction correction, double step_size) {
  const Extended h(step_size);
  const KnownStep<k, S> step(h);
  const Kinematics kinematics(step.system, BLieDF2nd::Options{.k = k, .correction = correction});
  const Vector v = kinematics.closure(step.state, step.affine).at(step.change).velocity;
  const Vector plain = step.affine.at(step.change).velocity;
  return {h * (v - step.exact), h * (plain - step.exact), h * (Extended(2.0) * plain - v - step.exact)};
}

// log2 of the ratio of the errors at 2^-7 and 2^-8; 1 + O(h) of it is the slope: within 0.1 where the next term of the
// error is below 10 times h (the largest seen, 8 of k = 5, is in the notes: 6.12, 6.06, 6.03).
constexpr double slope_tolerance = 0.1;

double slope(const LocalErrors& coarse, const LocalErrors& fine, Vector LocalErrors::*error) {
  return std::log2(to_double((coarse.*error).norm()) / to_double((fine.*error).norm()));
}

template <int k, class Kinematics>
void expect_slopes(Correction correction) {
  const auto coarse = local_errors<k, Kinematics>(correction, 0x1p-7);
  const auto fine = local_errors<k, Kinematics>(correction, 0x1p-8);
  EXPECT_NEAR(slope(coarse, fine, &LocalErrors::corrected), k + 1, slope_tolerance) << k;
  if (k < 3) return;
  EXPECT_NEAR(slope(coarse, fine, &LocalErrors::uncorrected), 3, slope_tolerance) << k;
  EXPECT_NEAR(slope(coarse, fine, &LocalErrors::wrong_sign), 3, slope_tolerance) << k;
  // L_k is the whole of it: what a wrong sign leaves is twice what none leaves.
  EXPECT_NEAR(to_double(fine.wrong_sign.norm() / fine.uncorrected.norm()), 2, 0.1) << k;
}

TEST(ExplicitCorrection, LeavesALocalErrorOfOrderKPlusOne) {
  for_every_k<1>([]<int k>() { expect_slopes<k, ExplicitCorrection<S>>(Correction::explicit_term); });
}

TEST(ImplicitCorrection, LeavesALocalErrorOfOrderKPlusOne) {
  for_every_k<3>([]<int k>() { expect_slopes<k, ImplicitCorrection<S>>(Correction::implicit_term); });
}

TEST(ExplicitCorrection, IsAbsentWhereNotAskedFor) {
  for_every_k<1>([]<int k>() {
    const auto errors = local_errors<k, ExplicitCorrection<S>>(Correction::none, 0x1p-7);
    EXPECT_EQ(to_double((errors.corrected - errors.uncorrected).norm()), 0.0) << k;
  });
}

TEST(ImplicitCorrection, SolvesItsFixedPointToRoundOff) {
  // v = plain - h^2 L(v), with h^2 L(v) from the derivatives that v itself makes.
  const auto check = []<int k>() {
    const Extended h(0x1p-5);
    const KnownStep<k, S> step(h);
    const ImplicitCorrection<S> kinematics(step.system, BLieDF2nd::Options{.k = k});
    const auto values = kinematics.closure(step.state, step.affine).at(step.change);
    const auto scaled_derivative = [&](int d) {
      const auto w = derivative_weights<Extended>(k + 1, d, 0.0);
      Vector v = values.velocity;
      Vector sum = w[0] * v;
      v = step.state.velocity;
      for (int i = 1; i <= k; ++i) {
        sum += w[std::size_t(i)] * v;
        if (i < k) v -= step.state.velocity_changes[i - 1];
      }
      return sum;
    };
    Vector correction;
    if (k <= 4)
      correction = leading_correction(S::Group{}, h, values.velocity, scaled_derivative(1));
    else
      correction = full_correction(S::Group{}, h, values.velocity, scaled_derivative(1), scaled_derivative(2),
                                   scaled_derivative(3));
    const Vector defect = step.affine.at(step.change).velocity - correction - values.velocity;
    EXPECT_LE(to_double(defect.norm()), 1e3 * to_double(Eigen::NumTraits<Extended>::epsilon())) << k;
    // h v' is gamma_1 (v_{n+1} - v_n) and what the earlier velocities give.
    const Vector acceleration =
        step.affine.scaled_acceleration +
        step.affine.velocity_slope * (values.velocity_change - step.affine.velocity_change);
    EXPECT_LE(to_double((acceleration - values.scaled_acceleration).norm()),
              1e3 * to_double(Eigen::NumTraits<Extended>::epsilon()))
        << k;
  };
  for_every_k<3>(check);
}

// In double, where h |v| is 0.1: the derivatives for the Newton matrix leave out N^3 (k = 3, 4), and the braces for k = 5, 6,
// a few h |v| / 720 times weights of up to 10. A simplified Newton iteration contracts by what is left out.
TEST(ImplicitCorrection, LinearizationIsTheDerivativeUpToWhatItLeavesOut) {
  using D = HeavyTopSO3<double>;
  const auto check = []<int k>() {
    RandomNumbers random(3);
    const D system{HeavyTopParameters{}};
    BdfState<D> state{system, k};
    state.h = 0.01;
    state.velocity = 6 * random.vector<3>();
    state.increment = state.velocity;
    state.kappa = 0.01 * random.vector<3>();
    for (int i = 0; i < k - 1; ++i) {
      state.velocity_changes.push(0.3 * random.vector<3>());
      state.increment_changes.push(0.3 * random.vector<3>());
    }
    const double slope = state.coefficients.gamma[0];
    const AffineClosure<D> affine{.base_increment = state.increment,
                                  .velocity = state.velocity,
                                  .velocity_slope = slope,
                                  .velocity_change = 0.3 * random.vector<3>(),
                                  .acceleration_slope = slope * slope,
                                  .scaled_acceleration = 0.3 * random.vector<3>()};
    const ImplicitCorrection<D> kinematics(system, BLieDF2nd::Options{.k = k});
    const auto closure = kinematics.closure(state, affine);
    const Eigen::Vector3d d = 0.1 * random.vector<3>();
    const auto derivatives = closure.linearization(d);
    for (int j = 0; j < 3; ++j) {
      const auto along = [&](double s) { return closure.at(d + s * Eigen::Vector3d::Unit(j)); };
      const Eigen::Vector3d velocity =
          five_point_derivative<double>([&](double s) { return along(s).velocity; });
      const Eigen::Vector3d acceleration =
          five_point_derivative<double>([&](double s) { return along(s).scaled_acceleration; });
      const double N = state.h / 12 * slope * state.velocity.norm() + 0.01;
      const double tolerance = slope * (k <= 4 ? N * N * N + 1e-9 : 0.01);
      EXPECT_LE((derivatives.velocity.col(j) - velocity).norm(), tolerance) << k << ' ' << j;
      EXPECT_LE((derivatives.scaled_acceleration.col(j) - acceleration).norm(), slope * tolerance)
          << k << ' ' << j;
    }
  };
  for_every_k<3>(check);
}

}  // namespace
}  // namespace liebench::lie_correction_test
