#include "integrators/step_equation.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "integrators/affine_closure.h"
#include "integrators/bdf_coefficients.h"
#include "problems/heavy_top.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/jets.h"

namespace liebench::step_equation_test {
namespace {

using Rotation = HeavyTopSO3<double>;
using Body = HeavyTopR3xSO3<double>;

template <class S>
AffineClosure<S> closure_in(const AffineClosure<typename S::template rebind<double>>& c) {
  using T = typename S::Scalar;
  return {.base_increment = c.base_increment.template cast<T>(),
          .velocity = c.velocity.template cast<T>(),
          .velocity_slope = T(c.velocity_slope),
          .velocity_change = c.velocity_change.template cast<T>(),
          .acceleration_slope = T(c.acceleration_slope),
          .scaled_acceleration = c.scaled_acceleration.template cast<T>()};
}

// A state somewhere: increments that turn by 0.3, offsets of their size.
template <class S, Form form = Form::index3>
struct Sample {
  static constexpr int n = StepEquation<S, form>::n;
  double h;
  Configuration<S> q;
  AffineClosure<S> closure;
  Eigen::Matrix<double, n, 1> z;

  explicit Sample(const S& system, double step_size) : h(step_size) {
    RandomNumbers random(3);
    constexpr int m = S::Group::dimension;
    q = S::Group::compose(system.initial_configuration(), S::Group::exp(random.vector<m>()));
    const double rate = 0.3 / h;
    closure = {.base_increment = rate * random.vector<m>(),
               .velocity = rate * random.vector<m>(),
               .velocity_slope = 1.5,
               .velocity_change = rate * random.vector<m>(),
               .acceleration_slope = 2.25,
               .scaled_acceleration = rate * random.vector<m>()};
    z = rate * random.vector<n>();
  }
};

template <class Equation, class System, class Closure>
typename Equation::Point evaluated(const System& system, const Configuration<System>& q_n, double h,
                                   const Closure& closure, const typename Equation::Unknowns& z) {
  typename Equation::Point point;
  Equation::evaluate(system, h, q_n, closure, z, point);
  return point;
}

// The Newton matrix is the derivative of the residual as a function of the unknowns: by Jets.
template <Form form, class S>
void expect_jacobian_is_the_derivative(const S& system, double h) {
  const Sample<S, form> s(system, h);
  constexpr int n = Sample<S, form>::n;
  using Jet = JetOf<12>;  // for all n, so that there is one type of them
  using JetSystem = typename S::template rebind<Jet>;
  using Equation = StepEquation<S, form>;
  using JetEquation = StepEquation<JetSystem, form>;
  typename JetEquation::Unknowns z;
  for (int i = 0; i < n; ++i) z(i) = Jet(s.z(i), i);
  const JetSystem jet_system = system.template cast<Jet>();
  typename JetEquation::Point point;
  JetEquation::evaluate(jet_system, Jet(h), S::Group::template cast<Jet>(s.q),
                        closure_in<JetSystem>(s.closure), z, point);
  typename JetEquation::Unknowns r;
  JetEquation::residual(jet_system, Jet(0.0), Jet(h), point, z, r);

  Eigen::Matrix<double, n, n> J;
  Equation::jacobian(system, 0.0, h, s.q, evaluated<Equation>(system, s.q, h, s.closure, s.z), s.z,
                     s.closure.linearization(s.z.template head<Equation::m>()), J);
  Eigen::Matrix<double, n, n> expected;
  for (int i = 0; i < n; ++i) expected.row(i) = r(i).v.template head<n>().transpose();
  // Entries are sums of fewer than ten products of entries as large as those of the matrix, and of h^2 K
  // times the tangent operator.
  const double scale = J.norm() + s.z.norm() * h;
  EXPECT_LE((J - expected).norm(), 256 * 2.3e-16 * scale) << S::formulation << ' ' << h;
}

TEST(StepEquation, JacobianIsTheDerivativeOfTheResidual) {
  for (const HeavyTopParameters& p : sample_tops())
    for (const double h : {1.0, 1e-2, 1e-5}) {
      expect_jacobian_is_the_derivative<Form::index3>(Rotation(p), h);
      expect_jacobian_is_the_derivative<Form::index3>(Body(p), h);
      expect_jacobian_is_the_derivative<Form::stabilized_index2>(Body(p), h);
    }
}

TEST(StepEquation, PointIsTheClosureOfTheIncrement) {
  const Body system(unsymmetric_top(1));
  const Sample<Body> s(system, 0.1);
  const auto point = evaluated<StepEquation<Body>>(system, s.q, s.h, s.closure, s.z);
  const Velocity<Body> d = s.z.head<6>();
  // Dq = base + d,  v = v_n + slope d + change,  h v' = slope d + offset.
  const Velocity<Body> turn = s.h * (s.closure.base_increment + d);
  const Velocity<Body> v = s.closure.velocity + 1.5 * d + s.closure.velocity_change;
  const Velocity<Body> scaled_acceleration = 2.25 * d + s.closure.scaled_acceleration;
  EXPECT_LE((point.step - turn).norm(), 1e-15);
  EXPECT_LE(Body::Group::separation(Body::Group::compose(s.q, Body::Group::exp(turn)), point.q).norm(),
            1e-15);
  EXPECT_LE((point.values.velocity - v).norm(), 1e-14 * v.norm());
  EXPECT_LE((point.values.scaled_acceleration - scaled_acceleration).norm(),
            1e-14 * scaled_acceleration.norm());
}

TEST(StepEquation, ResidualIsScaledByTheStepSize) {
  // (h r, Phi / h) with r = M v' + g + B^T lambda.
  const Body system(unsymmetric_top(2));
  const Sample<Body> s(system, 0.01);
  const auto point = evaluated<StepEquation<Body>>(system, s.q, s.h, s.closure, s.z);
  StepEquation<Body>::Unknowns r;
  StepEquation<Body>::residual(system, 0.0, s.h, point, s.z, r);
  const Velocity<Body> acceleration = point.values.scaled_acceleration / s.h;
  const Multipliers<Body> lambda = s.z.tail<3>() / s.h;
  const Velocity<Body> load = system.mass_matrix(point.q) * acceleration +
                              system.force(0.0, point.q, point.values.velocity) +
                              system.constraint_gradient(point.q).transpose() * lambda;
  EXPECT_LE((r.head<6>() - s.h * load).norm(),
            1e-14 * s.h * (load.norm() + acceleration.norm() + lambda.norm()));
  EXPECT_LE((r.tail<3>() - system.constraint(point.q) / s.h).norm(), 1e-15 / s.h);
}

// Scaled Newton matrix of the k-step method at the initial state of the fast top, and the limit h -> 0 of its
// condition: that of [alpha_0 gamma_1 M, B^T; B, 0] with the Steiner ratio m X^2 / J = 64 squared in it,
// 3.6e3 in the design notes, section 1.
template <int k>
double condition(double h) {
  const Body system{HeavyTopParameters{}};
  const auto c = bdf_coefficients<double>(k);
  const auto q = system.initial_configuration();
  const auto v = system.initial_velocity();
  const AffineClosure<Body> closure{.base_increment = v,
                                    .velocity = v,
                                    .velocity_slope = c.gamma[0],
                                    .velocity_change = Velocity<Body>::Zero(),
                                    .acceleration_slope = c.alpha[0] * c.gamma[0],
                                    .scaled_acceleration = Velocity<Body>::Zero()};
  Eigen::Matrix<double, 9, 1> z;
  z << Velocity<Body>::Zero(), Eigen::Vector3d(0, -319.5 * h, -317.3 * h);
  Eigen::Matrix<double, 9, 9> J;
  StepEquation<Body>::jacobian(system, 0.0, h, q, evaluated<StepEquation<Body>>(system, q, h, closure, z), z,
                               closure.linearization(Velocity<Body>::Zero()), J);
  const Eigen::VectorXd s = singular_values(J);
  return s(0) / s(8);
}

TEST(StepEquation, ConditionOfTheScaledMatrixDoesNotGrowAsTheStepSizeVanishes) {
  const double limit = condition<2>(1e-9);
  RecordProperty("limit", std::to_string(limit));
  for (const double h : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    // h C and h^2 K change it by the factor 1 + O(h |Omega|).
    EXPECT_LE(condition<2>(h), limit * (1 + 300 * h)) << h;
    EXPECT_GE(condition<2>(h), limit / (1 + 300 * h)) << h;
  }
  EXPECT_LE(condition<2>(1e-2), 2 * limit);
  EXPECT_LE(limit, 3.6e3);
  // alpha_0 gamma_1 scales the mass matrix: the condition grows with its square at most, and stays small.
  EXPECT_LE(condition<4>(1e-6), 1e4);
}

}  // namespace
}  // namespace liebench::step_equation_test
