#include "problems/heavy_top.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "groups/extended.h"
#include "integrators/consistent_projection.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/jets.h"

namespace liebench {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Body = HeavyTopR3xSO3<double>;
using Rotation = HeavyTopSO3<double>;

static_assert(MechanicalSystem<Rotation> && !ConstrainedSystem<Rotation>);
static_assert(ConstrainedSystem<Body>);
static_assert(ConstrainedSystem<HeavyTopR3xSO3<Extended>>);

constexpr double eps = 2.3e-16;

// Each entry of a derivative is a sum of fewer than ten products of at most four rounded factors; both sides of
// a comparison err: 64 eps of the size of the products. Differences err by eps^(4/5) instead.
constexpr double roundings = 64 * eps;
const double difference_error = 64 * std::pow(eps, 0.8);

// A configuration and velocity away from the constraint, and multipliers: derivatives hold there too.
struct BodyState {
  Body::Element q;
  Vector6 v, a;
  Vector lambda;
};

std::vector<BodyState> body_states() {
  std::vector<BodyState> all;
  RandomNumbers random(5);
  for (const RigidState& s : sample_states()) {
    BodyState b;
    b.q = {2 * random.vector<3>(), s.R};
    b.v << 4 * random.vector<3>(), s.omega;
    b.a << 7 * random.vector<3>(), s.omega_dot;
    b.lambda = 300 * random.vector<3>();
    all.push_back(b);
  }
  return all;
}

// --- both formulations -----------------------------------------------------------------------------------

TEST(HeavyTop, InertiaAboutTheTipIsThatOfThePaper) {
  // Eq. (57) from the data of eq. (58): J + m (|X|^2 I - X X^T), exact in binary.
  const Rotation system{HeavyTopParameters{}};
  EXPECT_EQ(system.mass_matrix(Matrix::Identity()),
            Matrix(Vector(15.234375, 0.46875, 15.234375).asDiagonal()));
}

TEST(HeavyTop, MassMatricesAreSymmetricPositiveDefinite) {
  for (const HeavyTopParameters& p : sample_tops()) {
    const Matrix M3 = Rotation(p).mass_matrix(Matrix::Identity());
    const Matrix6 M6 = Body(p).mass_matrix(Body(p).initial_configuration());
    EXPECT_LE((M3 - M3.transpose()).norm(), 4 * eps * M3.norm());
    EXPECT_EQ(M6, M6.transpose());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix>(M3).eigenvalues()(0), 0);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6>(M6).eigenvalues()(0), 0);
  }
}

TEST(HeavyTop, MomentumIsTheMassMatrixTimesTheVelocity) {
  RandomNumbers random(9);
  for (const HeavyTopParameters& p : sample_tops()) {
    const Rotation rotation(p);
    const Body body(p);
    const Vector w3 = random.vector<3>();
    const Vector6 w6 = random.vector<6>();
    const auto q = body.initial_configuration();
    EXPECT_LE((rotation.momentum(q.second, w3) - rotation.mass_matrix(q.second) * w3).norm(),
              roundings * rotation.mass_matrix(q.second).norm());
    EXPECT_LE((body.momentum(q, w6) - body.mass_matrix(q) * w6).norm(),
              roundings * body.mass_matrix(q).norm());
  }
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
  const Vector omega_dot = -J.inverse() * expected;
  EXPECT_NEAR(omega_dot(0), 661.34616923, 1e-8);
  const Vector lambda = Body(p).multipliers(Matrix::Identity(), omega, omega_dot);
  EXPECT_NEAR(lambda(0), 0.0, 1e-12);
  EXPECT_NEAR(lambda(1), -319.525988166, 1e-9);
  EXPECT_NEAR(lambda(2), -317.26246153846153846, 1e-9);
}

TEST(HeavyTop, InitialValuesAreTheDataAndConsistent) {
  for (const HeavyTopParameters& p : sample_tops()) {
    const Rotation rotation(p);
    const Body body(p);
    const auto q = body.initial_configuration();
    const auto v = body.initial_velocity();
    EXPECT_LE(SO3<double>::defect(q.second), 16 * eps);
    EXPECT_EQ(rotation.initial_configuration(), q.second);
    EXPECT_EQ(rotation.initial_velocity(), Vector(v.tail<3>()));
    EXPECT_LE(body.constraint(q).norm(), 16 * eps);
    EXPECT_LE((body.constraint_gradient(q) * v).norm(), roundings * (1 + v.norm()));
  }
}

TEST(HeavyTop, DampingIsTheDerivativeOfTheForceByTheVelocity) {
  for (const HeavyTopParameters& p : sample_tops()) {
    const Rotation rotation(p);
    for (const RigidState& s : sample_states()) {
      const auto force = [&](const auto& system, const auto& omega) {
        using T = typename std::decay_t<decltype(system)>::Scalar;
        return system.force(T(0.0), in_scalar_of(system, s.R), omega);
      };
      const Matrix C = rotation.damping(0.0, s.R, s.omega);
      const double scale = rotation.mass_matrix(s.R).norm() * (1 + s.omega.norm());
      EXPECT_LE((C - velocity_derivative_by_jets(rotation, s.omega, force)).norm(), roundings * scale);
      const double unit = 1 + s.omega.norm();
      // Quadratic in Omega: no truncation, the noise eps |g| / d only.
      EXPECT_LE((C - velocity_derivative_by_differences(rotation, s.omega, unit, force)).norm(),
                difference_error * (scale + p.mass * 10));
    }
    const Body body(p);
    for (const BodyState& s : body_states()) {
      const auto force = [&](const auto& system, const auto& v) {
        using Target = std::decay_t<decltype(system)>;
        using T = typename Target::Scalar;
        return system.force(T(0.0), Body::Group::cast<T>(s.q), v);
      };
      const Matrix6 C = body.damping(0.0, s.q, s.v);
      const double scale = body.mass_matrix(s.q).norm() * (1 + s.v.norm());
      EXPECT_LE((C - velocity_derivative_by_jets(body, s.v, force)).norm(), roundings * scale);
      EXPECT_LE((C - velocity_derivative_by_differences(body, s.v, 1 + s.v.norm(), force)).norm(),
                difference_error * (scale + p.mass * 10));
    }
  }
}

TEST(HeavyTop, StiffnessIsTheDerivativeOfTheResidualByTheConfiguration) {
  const Eigen::Matrix<double, 0, 1> none;
  for (const HeavyTopParameters& p : sample_tops()) {
    const Rotation rotation(p);
    for (const RigidState& s : sample_states()) {
      const auto residual = [&](const auto& system, const auto& R) {
        using T = typename std::decay_t<decltype(system)>::Scalar;
        return (system.momentum(R, in_scalar_of(system, s.omega_dot)) +
                system.force(T(0.0), R, in_scalar_of(system, s.omega)))
            .eval();
      };
      const Matrix K = rotation.stiffness(0.0, s.R, s.omega, s.omega_dot, none);
      const double scale = K.norm() + p.mass * 10;
      EXPECT_LE((K - derivative_by_jets(rotation, s.R, residual)).norm(), roundings * scale);
      // The noise is that of the whole residual, gyroscopic terms included.
      const double noise = rotation.mass_matrix(s.R).norm() * (s.omega_dot.norm() + s.omega.squaredNorm());
      EXPECT_LE((K - derivative_by_differences(rotation, s.R, residual)).norm(),
                difference_error * (scale + noise));
    }
    const Body body(p);
    for (const BodyState& s : body_states()) {
      const auto residual = [&](const auto& system, const auto& q) {
        using T = typename std::decay_t<decltype(system)>::Scalar;
        return (system.momentum(q, in_scalar_of(system, s.a)) +
                system.force(T(0.0), q, in_scalar_of(system, s.v)) +
                system.constraint_force(q, in_scalar_of(system, s.lambda)))
            .eval();
      };
      const Matrix6 K = body.stiffness(0.0, s.q, s.v, s.a, s.lambda);
      const double scale = s.lambda.norm() * (1 + s.q.first.norm());
      EXPECT_LE((K - derivative_by_jets(body, s.q, residual)).norm(), roundings * scale);
      const double noise = body.mass_matrix(s.q).norm() * (s.a.norm() + s.v.squaredNorm());
      EXPECT_LE((K - derivative_by_differences(body, s.q, residual)).norm(),
                difference_error * (scale + noise));
    }
  }
}

// g carries the potential: -(R^T d/dx) of the energy, the generalised force that a change of q meets.
TEST(HeavyTop, ForceAtRestIsTheGradientOfTheEnergy) {
  for (const HeavyTopParameters& p : sample_tops()) {
    const Rotation rotation(p);
    const Body body(p);
    for (const BodyState& s : body_states()) {
      const auto energy = [](const auto& system, const auto& q) {
        using System = std::decay_t<decltype(system)>;
        using T = typename System::Scalar;
        const typename System::Group::Tangent rest = System::Group::Tangent::Constant(T(0.0));
        return Eigen::Matrix<T, 1, 1>(system.energy(q, rest));
      };
      const double scale = p.mass * 10 * (1 + s.q.first.norm());
      const Vector at_rest = rotation.force(0.0, s.q.second, Vector::Zero());
      EXPECT_LE((derivative_by_jets(rotation, s.q.second, energy).transpose() - at_rest).norm(),
                roundings * scale);
      const Vector6 body_at_rest = body.force(0.0, s.q, Vector6::Zero());
      EXPECT_LE((derivative_by_jets(body, s.q, energy).transpose() - body_at_rest).norm(), roundings * scale);
    }
  }
}

TEST(HeavyTop, EnergyIsConstantAlongTheEquationsOfMotion) {
  const auto rate = [](const auto& system, const auto& q, const auto& v, const auto& a) {
    return directional_derivative_by_jets(system, q, v, [&](const auto& jets, const auto& at, const auto& s) {
      using System = std::decay_t<decltype(jets)>;
      const typename System::Group::Tangent velocity = in_scalar_of(jets, v) + in_scalar_of(jets, a) * s;
      return Eigen::Matrix<typename System::Scalar, 1, 1>(jets.energy(at, velocity));
    })(0);
  };
  for (const HeavyTopParameters& p : sample_tops()) {
    const Rotation rotation(p);
    const Body body(p);
    for (const RigidState& s : sample_states()) {
      const Matrix M = rotation.mass_matrix(s.R);
      const Vector a = -M.ldlt().solve(rotation.force(0.0, s.R, s.omega));
      const double power = M.norm() * s.omega.norm() * (a.norm() + s.omega.squaredNorm()) + 10 * p.mass;
      EXPECT_LE(std::abs(rate(rotation, s.R, s.omega, a)), roundings * power);

      const auto q = body.configuration(s.R);
      const Vector6 v = body.velocity(s.R, s.omega);
      const auto solution =
          solve_saddle_point<Body>(body, q, -body.force(0.0, q, v), -body.constraint_curvature(q, v));
      ASSERT_TRUE(solution.has_value());
      const double body_power = (M.norm() + body.mass_matrix(q).norm()) * (1 + v.norm()) *
                                (solution->x.norm() + v.squaredNorm() + 10);
      EXPECT_LE(std::abs(rate(body, q, v, solution->x)), roundings * body_power);
    }
  }
}

// --- the constraint of the free body ---------------------------------------------------------------------

TEST(HeavyTop, ConstraintGradientIsTheDerivativeOfTheConstraint) {
  const auto phi = [](const auto& system, const auto& q) { return system.constraint(q); };
  for (const HeavyTopParameters& p : sample_tops()) {
    const Body body(p);
    for (const BodyState& s : body_states()) {
      const auto B = body.constraint_gradient(s.q);
      const double scale = 1 + s.q.first.norm();
      EXPECT_LE((B - derivative_by_jets(body, s.q, phi)).norm(), roundings * scale);
      EXPECT_LE((B - derivative_by_differences(body, s.q, phi)).norm(), difference_error * scale);
    }
  }
}

TEST(HeavyTop, ConstraintGradientHasFullRankEverywhere) {
  // The translational block is -R^T: B B^T >= I.
  for (const BodyState& s : body_states()) {
    const auto B = Body(HeavyTopParameters{}).constraint_gradient(s.q);
    const Matrix gram = B * B.transpose();
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix>(gram).eigenvalues()(0), 1 - 16 * eps);
  }
}

TEST(HeavyTop, ConstraintForceIsTheTransposedGradientTimesLambda) {
  for (const HeavyTopParameters& p : sample_tops()) {
    const Body body(p);
    for (const BodyState& s : body_states()) {
      const Vector6 expected = body.constraint_gradient(s.q).transpose() * s.lambda;
      EXPECT_LE((body.constraint_force(s.q, s.lambda) - expected).norm(),
                roundings * s.lambda.norm() * (1 + s.q.first.norm()));
    }
  }
}

TEST(HeavyTop, ConstraintCurvatureIsTheRateOfTheGradientAlongTheVelocity) {
  for (const HeavyTopParameters& p : sample_tops()) {
    const Body body(p);
    for (const BodyState& s : body_states()) {
      const auto rate =
          directional_derivative_by_jets(body, s.q, s.v, [&](const auto& system, const auto& q, const auto&) {
            return (system.constraint_gradient(q) * in_scalar_of(system, s.v)).eval();
          });
      const Vector Z = body.constraint_curvature(s.q, s.v);
      const double scale = (1 + s.q.first.norm()) * (1 + s.v.squaredNorm());
      EXPECT_LE((Z - rate).norm(), roundings * scale);
      // And as the second derivative of Phi at constant v, by differences in extended precision.
      const HeavyTopR3xSO3<Extended> extended(p);
      using Group = HeavyTopR3xSO3<Extended>::Group;
      const auto q = Body::Group::cast<Extended>(s.q);
      const Group::Tangent v = s.v.cast<Extended>();
      const double d = 1e-8 / (1 + s.v.norm());
      const auto phi = [&](double t) {
        return extended.constraint(Group::compose(q, Group::exp(v * Extended(t))));
      };
      const Vector difference =
          ((phi(d) - phi(0) * Extended(2.0) + phi(-d)) / (Extended(d) * d)).cast<double>();
      // Truncation d^2 |v|^4 / 12, noise 4 eps / d^2: both 1e-15 of the scale.
      EXPECT_LE((Z - difference).norm(), 1e-13 * scale);
    }
  }
}

// --- one physics -----------------------------------------------------------------------------------------

// M, B and the loads of the free body make a saddle point matrix of condition 3.6e3 for the default top (about
// 1e2 for the others).
constexpr double condition = 4e3;

template <class T>
void expect_same_motion(double unit) {
  for (const HeavyTopParameters& p : sample_tops()) {
    const HeavyTopSO3<T> rotation(p);
    const HeavyTopR3xSO3<T> body(p);
    for (const RigidState& s : sample_states()) {
      using Vector3 = Eigen::Matrix<T, 3, 1>;
      // A rotation to the digits of T, also where the sample is one of doubles.
      Eigen::Matrix<T, 3, 3> R = s.R.template cast<T>();
      for (int i = 0; i < 2; ++i) R = SO3<T>::renormalized(R);
      const Vector3 omega = s.omega.template cast<T>();
      const Vector3 omega_dot = -rotation.mass_matrix(R).ldlt().solve(rotation.force(T(0.0), R, omega));

      const auto q = body.configuration(R);
      const auto v = body.velocity(R, omega);
      const auto solution = solve_saddle_point<HeavyTopR3xSO3<T>>(body, q, -body.force(T(0.0), q, v),
                                                                  -body.constraint_curvature(q, v));
      ASSERT_TRUE(solution.has_value());
      const double loads = to_double(T(body.force(T(0.0), q, v).norm() + v.squaredNorm())) + 10 * p.mass;
      const auto acceleration = body.acceleration(R, omega, omega_dot);
      EXPECT_LE(to_double(T((solution->x - acceleration).norm())), condition * unit * loads);
      EXPECT_LE(to_double(T((solution->y - body.multipliers(R, omega, omega_dot)).norm())),
                condition * unit * loads * (1 + p.mass));
      // Position, velocity and acceleration satisfy the constraint and its two derivatives.
      EXPECT_LE(to_double(T(body.constraint(q).norm())), 16 * unit);
      EXPECT_LE(to_double(T((body.constraint_gradient(q) * v).norm())), 64 * unit * (1 + s.omega.norm()));
      EXPECT_LE(
          to_double(T((body.constraint_gradient(q) * acceleration + body.constraint_curvature(q, v)).norm())),
          64 * unit * loads);
      // The energies agree: Steiner.
      const double energy_scale =
          to_double(rotation.mass_matrix(R).norm()) * (1 + s.omega.squaredNorm()) + 10 * p.mass;
      EXPECT_LE(std::abs(to_double(T(rotation.energy(R, omega) - body.energy(q, v)))),
                64 * unit * energy_scale);
    }
  }
}

TEST(HeavyTop, BothFormulationsDescribeTheSameMotion) {
  expect_same_motion<double>(eps);
}

TEST(HeavyTop, BothFormulationsDescribeTheSameMotionInExtendedPrecision) {
  expect_same_motion<Extended>(to_double(Eigen::NumTraits<Extended>::epsilon()));
}

TEST(HeavyTop, CastReadsTheDecimalsAgain) {
  // 9.81 as an extended number is not the double nearest to it.
  const auto extended = Rotation(HeavyTopParameters{}).cast<Extended>();
  const Eigen::Matrix<Extended, 3, 1> at_rest = Eigen::Matrix<Extended, 3, 1>::Constant(Extended(0.0));
  const Extended force = extended.force(Extended(0.0), SO3<Extended>::identity(), at_rest)(0);
  EXPECT_LE(std::abs(to_double(Extended(force * 100.0 - 981.0 * 15.0))), 1e-26);
}

}  // namespace
}  // namespace liebench
