#include "problems/heavy_top.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "groups/extended.h"
#include "integrators/consistent_projection.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/heavy_top_formulations.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/jets.h"

namespace liebench::heavy_top_test {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;
using Body = HeavyTopR3xSO3<double>;
using Rotation = HeavyTopSO3<double>;

constexpr double eps = 2.3e-16;

// Each entry of a derivative is a sum of fewer than ten products of at most four rounded factors; both sides of
// a comparison err: 64 eps of the size of the products. Differences err by eps^(4/5) instead.
constexpr double roundings = 64 * eps;
const double difference_error = 64 * std::pow(eps, 0.8);

// The element of the group of S for the attitude R and, where the body is free, the position x.
template <class S>
Configuration<S> placed(const Eigen::Matrix<typename S::Scalar, 3, 1>& x,
                        const Eigen::Matrix<typename S::Scalar, 3, 3>& R) {
  if constexpr (S::constraints > 0) {
    return S::Group::representative({x, R});
  } else {
    return S::Group::representative(R);
  }
}

// A configuration and velocity away from the constraint, and multipliers: derivatives hold there too.
template <class S>
struct State {
  Configuration<S> q;
  Velocity<S> v, a;
  Multipliers<S> lambda;
  double distance;  // of the centre of mass from the origin
};

template <class S>
std::vector<State<S>> states() {
  constexpr int free = S::Group::dimension - 3;  // 0 or 3
  std::vector<State<S>> all;
  RandomNumbers random(5);
  for (const TopState& r : sample_states()) {
    State<S> s;
    const Vector x = 2 * random.vector<3>();
    s.q = placed<S>(x, r.R);
    s.v << 4 * random.vector<free>(), r.omega;
    s.a << 7 * random.vector<free>(), r.omega_dot;
    s.lambda = 300 * random.vector<S::constraints>();
    s.distance = x.norm();
    all.push_back(s);
  }
  return all;
}

// What limits every law: the mass matrices of the formulation and of the rotation about the tip.
template <class S>
double inertia_scale(const S& system) {
  return to_double(system.mass_matrix(system.initial_configuration()).norm());
}

// --- all formulations ------------------------------------------------------------------------------------

template <class Formulation>
class HeavyTopLaws : public ::testing::Test {};
TYPED_TEST_SUITE(HeavyTopLaws, AllHeavyTops, HeavyTopNames);

TYPED_TEST(HeavyTopLaws, HoldForASystem) {
  using S = typename TypeParam::template In<double>;
  using E = typename TypeParam::template In<Extended>;
  static_assert(MechanicalSystem<S> && MechanicalSystem<E>);
  static_assert(ConstrainedSystem<S> == (S::constraints > 0) && ConstrainedSystem<E> == ConstrainedSystem<S>);
  static_assert(std::same_as<typename S::template rebind<Extended>, E>);
  EXPECT_STREQ(S::formulation, E::formulation);
}

TYPED_TEST(HeavyTopLaws, MassMatrixIsSymmetricPositiveDefinite) {
  using S = typename TypeParam::template In<double>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    const VelocityMatrix<S> M = system.mass_matrix(system.initial_configuration());
    EXPECT_LE((M - M.transpose()).norm(), 4 * eps * M.norm());
    EXPECT_TRUE(is_positive_definite(M));
  }
}

TYPED_TEST(HeavyTopLaws, MomentumIsTheMassMatrixTimesTheVelocity) {
  using S = typename TypeParam::template In<double>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    for (const State<S>& s : states<S>()) {
      const VelocityMatrix<S> M = system.mass_matrix(s.q);
      EXPECT_LE((system.momentum(s.q, s.v) - M * s.v).norm(), roundings * M.norm() * s.v.norm());
    }
  }
}

TYPED_TEST(HeavyTopLaws, InitialValuesAreTheDataAndConsistent) {
  using S = typename TypeParam::template In<double>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    const HeavyTopData<double> data(p);
    const auto q = system.initial_configuration();
    const auto v = system.initial_velocity();
    EXPECT_LE(S::Group::defect(q), 16 * eps);
    EXPECT_EQ(Vector(v.template tail<3>()), data.omega0);
    const auto expected = placed<S>(data.R0 * data.center_of_mass, data.R0);
    EXPECT_LE(S::Group::separation(expected, q).norm(), 16 * eps);
    if constexpr (S::constraints > 0) {
      EXPECT_LE(system.constraint(q).norm(), 16 * eps);
      EXPECT_LE((system.constraint_gradient(q) * v).norm(), roundings * (1 + v.norm()));
    }
  }
}

TYPED_TEST(HeavyTopLaws, DampingIsTheDerivativeOfTheForceByTheVelocity) {
  using S = typename TypeParam::template In<double>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    for (const State<S>& s : states<S>()) {
      const auto force = [&](const auto& at, const auto& v) {
        using T = typename std::decay_t<decltype(at)>::Scalar;
        return at.force(T(0.0), S::Group::template cast<T>(s.q), v);
      };
      const VelocityMatrix<S> C = system.damping(0.0, s.q, s.v);
      const double unit = 1 + s.v.norm();
      const double scale = inertia_scale(system) * unit;
      EXPECT_LE((C - velocity_derivative_by_jets(system, s.v, force)).norm(), roundings * scale);
      // Quadratic in v: no truncation, the noise eps |g| / d only.
      EXPECT_LE((C - velocity_derivative_by_differences(system, s.v, unit, force)).norm(),
                difference_error * (scale + p.mass * 10));
    }
  }
}

TYPED_TEST(HeavyTopLaws, StiffnessIsTheDerivativeOfTheResidualByTheConfiguration) {
  using S = typename TypeParam::template In<double>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    for (const State<S>& s : states<S>()) {
      const auto residual = [&](const auto& at, const auto& q) {
        using System = std::decay_t<decltype(at)>;
        using T = typename System::Scalar;
        Velocity<System> r =
            at.momentum(q, in_scalar_of(at, s.a)) + at.force(T(0.0), q, in_scalar_of(at, s.v));
        if constexpr (S::constraints > 0) r += at.constraint_force(q, in_scalar_of(at, s.lambda));
        return r;
      };
      const VelocityMatrix<S> K = system.stiffness(0.0, s.q, s.v, s.a, s.lambda);
      const double scale = s.lambda.norm() * (1 + s.distance) + K.norm() + p.mass * 10;
      EXPECT_LE((K - derivative_by_jets(system, s.q, residual)).norm(), roundings * scale);
      // The noise is that of the whole residual, gyroscopic terms included.
      const double noise = inertia_scale(system) * (s.a.norm() + s.v.squaredNorm());
      EXPECT_LE((K - derivative_by_differences(system, s.q, residual)).norm(),
                difference_error * (scale + noise));
    }
  }
}

// g carries the potential: -(R^T d/dx) of the energy, the generalised force that a change of q meets.
TYPED_TEST(HeavyTopLaws, ForceAtRestIsTheGradientOfTheEnergy) {
  using S = typename TypeParam::template In<double>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    for (const State<S>& s : states<S>()) {
      const auto energy = [](const auto& at, const auto& q) {
        using System = std::decay_t<decltype(at)>;
        using T = typename System::Scalar;
        const Velocity<System> rest = Velocity<System>::Constant(T(0.0));
        return Eigen::Matrix<T, 1, 1>(at.energy(q, rest));
      };
      const Velocity<S> at_rest = system.force(0.0, s.q, Velocity<S>::Zero());
      EXPECT_LE((derivative_by_jets(system, s.q, energy).transpose() - at_rest).norm(),
                roundings * p.mass * 10 * (1 + s.distance));
    }
  }
}

// d/dt of f(q, v) along q' = q v~, v' = a, by Jets.
template <class S, class F>
double rate(const S& system, const Configuration<S>& q, const Velocity<S>& v, const Velocity<S>& a,
            const F& f) {
  return directional_derivative_by_jets(system, q, v, [&](const auto& jets, const auto& at, const auto& s) {
    using System = std::decay_t<decltype(jets)>;
    const Velocity<System> velocity = in_scalar_of(jets, v) + in_scalar_of(jets, a) * s;
    return Eigen::Matrix<typename System::Scalar, 1, 1>(f(jets, at, velocity));
  })(0);
}

TYPED_TEST(HeavyTopLaws, EnergyAndVerticalAngularMomentumAreConstantAlongTheEquationsOfMotion) {
  using S = typename TypeParam::template In<double>;
  const auto energy = [](const auto& at, const auto& q, const auto& v) { return at.energy(q, v); };
  const auto momentum = [](const auto& at, const auto& q, const auto& v) {
    return at.angular_momentum(q, v);
  };
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    for (const TopState& r : sample_states()) {
      const auto q = system.configuration(r.R);
      const auto v = system.velocity(r.R, r.omega);
      NoAudit audit;
      const auto dynamics = consistent_dynamics(system, 0.0, q, v, audit);
      ASSERT_TRUE(dynamics.has_value());
      const Velocity<S>& a = dynamics->acceleration;
      const double torque =
          (inertia_scale(system) + inertia_scale(Rotation(p))) * (a.norm() + v.squaredNorm() + 10);
      EXPECT_LE(std::abs(rate(system, q, v, a, energy)), roundings * torque * (1 + v.norm()));
      EXPECT_LE(std::abs(rate(system, q, v, a, momentum)), roundings * torque);
    }
  }
}

// M, B and the loads of the free body make a saddle point matrix of condition 3.6e3 for the default top (about
// 1e2 for the others).
constexpr double condition = 4e3;

// Against the rotation about the tip, eq. (57), whose equations were compared with the paper.
template <class S>
void expect_the_motion_of_the_paper() {
  using T = typename S::Scalar;
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  const double unit = to_double(Eigen::NumTraits<T>::epsilon());
  for (const HeavyTopParameters& p : sample_tops()) {
    const HeavyTopSO3<T> rotation(p);
    const HeavyTopR3xSO3<T> body(p);
    const S system(p);
    for (const TopState& s : sample_states()) {
      // A rotation to the digits of T, also where the sample is one of doubles.
      Eigen::Matrix<T, 3, 3> R = s.R.template cast<T>();
      for (int i = 0; i < 2; ++i) R = SO3<T>::renormalized(R);
      const Vector3 omega = s.omega.template cast<T>();
      NoAudit audit;
      const Vector3 omega_dot = consistent_dynamics(rotation, T(0.0), R, omega, audit)->acceleration;

      const auto q = system.configuration(R);
      const auto v = system.velocity(R, omega);
      const auto a = system.acceleration(R, omega, omega_dot);
      const auto lambda = system.multipliers(R, omega, omega_dot);
      const auto expected = placed<S>(body.configuration(R).first, R);
      EXPECT_LE(S::Group::separation(expected, q).norm(), 16 * unit);

      const double loads = to_double(T(system.force(T(0.0), q, v).norm() + v.squaredNorm())) + 10 * p.mass;
      const auto solution = consistent_dynamics(system, T(0.0), q, v, audit);
      ASSERT_TRUE(solution.has_value());
      EXPECT_LE(to_double(T((solution->acceleration - a).norm())), condition * unit * loads);
      if constexpr (S::constraints > 0) {
        // lambda is the same force in all of them.
        EXPECT_EQ(to_double(T((lambda - body.multipliers(R, omega, omega_dot)).norm())), 0.0);
        EXPECT_LE(to_double(T((solution->lambda - lambda).norm())), condition * unit * loads * (1 + p.mass));
        // Position, velocity and acceleration satisfy the constraint and its two derivatives.
        EXPECT_LE(to_double(T(system.constraint(q).norm())), 16 * unit);
        const ConstraintGradient<S> B = system.constraint_gradient(q);
        EXPECT_LE(to_double(T((B * v).norm())), 64 * unit * (1 + s.omega.norm()));
        EXPECT_LE(to_double(T((B * a + system.constraint_curvature(q, v)).norm())), 64 * unit * loads);
      }
      // The invariants agree: Steiner.
      const double speed = 1 + s.omega.norm(), inertia = inertia_scale(rotation);
      EXPECT_LE(std::abs(to_double(T(rotation.energy(R, omega) - system.energy(q, v)))),
                64 * unit * (inertia * speed * speed + 10 * p.mass));
      EXPECT_LE(std::abs(to_double(T(rotation.angular_momentum(R, omega) - system.angular_momentum(q, v)))),
                64 * unit * inertia * speed);
    }
  }
}

TYPED_TEST(HeavyTopLaws, DescribeTheMotionOfThePaper) {
  expect_the_motion_of_the_paper<typename TypeParam::template In<double>>();
}

TYPED_TEST(HeavyTopLaws, DescribeTheMotionOfThePaperInExtendedPrecision) {
  expect_the_motion_of_the_paper<typename TypeParam::template In<Extended>>();
}

// --- the constraint of the free body ---------------------------------------------------------------------

template <class Formulation>
class HeavyTopConstraint : public ::testing::Test {};
TYPED_TEST_SUITE(HeavyTopConstraint, ConstrainedHeavyTops, HeavyTopNames);

TYPED_TEST(HeavyTopConstraint, GradientIsTheDerivativeOfTheConstraint) {
  using S = typename TypeParam::template In<double>;
  const auto phi = [](const auto& system, const auto& q) { return system.constraint(q); };
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    for (const State<S>& s : states<S>()) {
      const auto B = system.constraint_gradient(s.q);
      const double scale = 1 + s.distance;
      EXPECT_LE((B - derivative_by_jets(system, s.q, phi)).norm(), roundings * scale);
      EXPECT_LE((B - derivative_by_differences(system, s.q, phi)).norm(), difference_error * scale);
    }
  }
}

TYPED_TEST(HeavyTopConstraint, GradientHasFullRankEverywhere) {
  using S = typename TypeParam::template In<double>;
  // The translational block is a rotation, up to its sign: B B^T >= I.
  for (const State<S>& s : states<S>()) {
    const auto B = S(HeavyTopParameters{}).constraint_gradient(s.q);
    const Matrix gram = B * B.transpose();
    EXPECT_GE(smallest_eigenvalue(gram), 1 - 16 * eps);
  }
}

TYPED_TEST(HeavyTopConstraint, ForceIsTheTransposedGradientTimesLambda) {
  using S = typename TypeParam::template In<double>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    for (const State<S>& s : states<S>()) {
      const Velocity<S> expected = system.constraint_gradient(s.q).transpose() * s.lambda;
      EXPECT_LE((system.constraint_force(s.q, s.lambda) - expected).norm(),
                roundings * s.lambda.norm() * (1 + s.distance));
    }
  }
}

TYPED_TEST(HeavyTopConstraint, GradientDerivativeIsThatOfTheGradientTimesAVelocity) {
  using S = typename TypeParam::template In<double>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    for (const State<S>& s : states<S>()) {
      const auto Bv = [&](const auto& at, const auto& q) {
        return (at.constraint_gradient(q) * in_scalar_of(at, s.v)).eval();
      };
      const auto Z = system.constraint_gradient_derivative(s.q, s.v);
      const double scale = (1 + s.distance) * (1 + s.v.norm());
      EXPECT_LE((Z - derivative_by_jets(system, s.q, Bv)).norm(), roundings * scale);
      EXPECT_LE((Z * s.v - system.constraint_curvature(s.q, s.v)).norm(), roundings * scale * s.v.norm());
    }
  }
}

TYPED_TEST(HeavyTopConstraint, CurvatureIsTheRateOfTheGradientAlongTheVelocity) {
  using S = typename TypeParam::template In<double>;
  using E = typename TypeParam::template In<Extended>;
  for (const HeavyTopParameters& p : sample_tops()) {
    const S system(p);
    const E extended(p);
    for (const State<S>& s : states<S>()) {
      const auto rate =
          directional_derivative_by_jets(system, s.q, s.v, [&](const auto& at, const auto& q, const auto&) {
            return (at.constraint_gradient(q) * in_scalar_of(at, s.v)).eval();
          });
      const Vector Z = system.constraint_curvature(s.q, s.v);
      const double scale = (1 + s.distance) * (1 + s.v.squaredNorm());
      EXPECT_LE((Z - rate).norm(), roundings * scale);
      // And as the second derivative of Phi at constant v, by differences in extended precision.
      using Group = typename E::Group;
      const auto q = Group::renormalized(S::Group::template cast<Extended>(s.q));
      const Velocity<E> v = s.v.template cast<Extended>();
      const double d = 1e-8 / (1 + s.v.norm());
      const auto phi = [&](double t) {
        return extended.constraint(Group::compose(q, Group::exp(v * Extended(t))));
      };
      const Vector difference =
          ((phi(d) - phi(0) * Extended(2.0) + phi(-d)) / (Extended(d) * d)).template cast<double>();
      // Truncation d^2 |v|^4 / 12, noise 4 eps / d^2: both 1e-15 of the scale.
      EXPECT_LE((Z - difference).norm(), 1e-13 * scale);
    }
  }
}

// --- the paper -------------------------------------------------------------------------------------------

TEST(HeavyTop, FormulationsHaveTheirNames) {
  std::vector<std::string> names;
  const auto add = [&]<class... F>(std::tuple<F...>) {
    (names.emplace_back(F::template In<double>::formulation), ...);
  };
  add(HeavyTopFormulations{});
  EXPECT_EQ(names, (std::vector<std::string>{"SO3", "S3", "R3xSO3", "R3xS3", "SE3", "S3|xR3", "UDQ"}));
}

TEST(HeavyTop, InertiaAboutTheTipIsThatOfThePaper) {
  // Eq. (57) from the data of eq. (58): J + m (|X|^2 I - X X^T), exact in binary.
  const Rotation system{HeavyTopParameters{}};
  EXPECT_EQ(system.mass_matrix(Matrix::Identity()),
            Matrix(Vector(15.234375, 0.46875, 15.234375).asDiagonal()));
}

TEST(HeavyTop, EquationsOfMotionAreThoseOfThePaper) {
  // Eq. (57): J Omega' + Omega x J Omega - X x R^T m gamma, and eq. (58), with the default data by hand.
  const HeavyTopParameters p;
  const Vector omega(0, 150, -4.61538), X(0, 1, 0), weight(0, 0, -15 * 9.81);
  const Matrix J = Vector(15.234375, 0.46875, 15.234375).asDiagonal();
  const Vector expected = omega.cross(J * omega) - X.cross(weight);
  EXPECT_LE((Rotation(p).force(0.0, Matrix::Identity(), omega) - expected).norm(),
            roundings * expected.norm());
  // the design notes, section 7.1: Omega'(0) and lambda(0).
  const Vector omega_dot = -dense_solution(J, expected);
  EXPECT_NEAR(omega_dot(0), 661.34616923, 1e-8);
  const Vector lambda = Body(p).multipliers(Matrix::Identity(), omega, omega_dot);
  EXPECT_NEAR(lambda(0), 0.0, 1e-12);
  EXPECT_NEAR(lambda(1), -319.525988166, 1e-9);
  EXPECT_NEAR(lambda(2), -317.26246153846153846, 1e-9);
}

TEST(HeavyTop, CastReadsTheDecimalsAgain) {
  // 9.81 as an extended number is not the double nearest to it.
  const auto extended = Rotation(HeavyTopParameters{}).cast<Extended>();
  const Eigen::Matrix<Extended, 3, 1> at_rest = Eigen::Matrix<Extended, 3, 1>::Constant(Extended(0.0));
  const Extended force = extended.force(Extended(0.0), SO3<Extended>::identity(), at_rest)(0);
  EXPECT_LE(std::abs(to_double(Extended(force * 100.0 - 981.0 * 15.0))), 1e-26);
}

}  // namespace
}  // namespace liebench::heavy_top_test
