#include "integrators/half_explicit.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "groups/real_space.h"
#include "integrators/half_explicit_tableau.h"
#include "problems/audited_system.h"
#include "problems/heavy_top.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"

namespace liebench::half_explicit_test {
namespace {

using Options = HalfExplicit::Options;
using Tableau = HalfExplicit::Tableau;
constexpr std::array all_tableaus{Tableau::herk3, Tableau::herk4, Tableau::hedop5};
constexpr double eps = 2.3e-16;

std::vector<Options> all_options() {
  std::vector<Options> all;
  for (const Tableau tableau : all_tableaus)
    for (const bool projection : {false, true}) all.push_back({tableau, projection});
  return all;
}

std::string text(const Options& options) {
  return std::to_string(int(options.tableau)) + (options.projection ? " projected" : "");
}

ConvergenceOrders orders(Tableau tableau) {
  return HalfExplicit::with_tableau(tableau, [](auto chosen) { return chosen.orders; });
}

// --- a linear space: a textbook loop --------------------------------------------------------------------------------------------

using Pendulum = Particle<double, Circle>;

// The stages as they are written, with the linear system of each in one piece.
template <std::size_t s>
void textbook_step(const HalfExplicitTableau<s>& tableau, const Pendulum& system, double h,
                   Eigen::Vector2d& q, Eigen::Vector2d& v, double& lambda) {
  const auto weight = [&](std::size_t i, std::size_t j) { return value_of<double>(tableau.a[i][j]); };
  std::vector<Eigen::Vector2d> Q(s + 1, q), V(s + 1, v), dq(s), dv(s);
  std::vector<double> lambdas(s);
  for (std::size_t i = 0; i < s; ++i) {
    dq[i] = V[i];
    for (std::size_t j = 0; j <= i; ++j) Q[i + 1] += h * weight(i + 1, j) * dq[j];
    for (std::size_t j = 0; j < i; ++j) V[i + 1] += h * weight(i + 1, j) * dv[j];
    const Eigen::Matrix2d M = system.mass_matrix(Q[i]);
    const Eigen::Vector2d g = system.force(0.0, Q[i], V[i]);
    if (i == 0) {
      dv[i] = M.inverse() * (-g - Q[i] * lambda);
    } else {
      Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
      A.topLeftCorner<2, 2>() = M;
      A.topRightCorner<2, 1>() = Q[i];
      A.bottomLeftCorner<1, 2>() = h * weight(i + 1, i) * Q[i + 1].transpose();
      Eigen::Vector3d b;
      b << -g, -Q[i + 1].dot(V[i + 1]);
      const Eigen::Vector3d x = dense_solution(A, b);
      dv[i] = x.head<2>();
      lambdas[i] = x(2);
    }
    V[i + 1] += h * weight(i + 1, i) * dv[i];
  }
  q = Q[tableau.end];
  v = V[tableau.end];
  lambda = 0.0;
  for (std::size_t i = 0; i < s; ++i) lambda += value_of<double>(tableau.d[i]) * lambdas[i];
}

template <std::size_t s>
void expect_the_textbook_method(const HalfExplicitTableau<s>& tableau, Tableau option) {
  const Pendulum system(2.0, ParticleForce::spring_behind_a_wall);
  constexpr double h = 1.0 / 32;
  Eigen::Vector2d q(1.0, 0.0), v(0.0, 1.0);
  double lambda = 2.0;  // of the circular motion: m v^2
  const auto stepper = make_stepper<HalfExplicit, Pendulum>({option}, system);
  const std::array points{
      SolutionPoint<Pendulum>{0.0, q, v, Eigen::Vector2d::Zero(), Eigen::Matrix<double, 1, 1>(lambda)}};
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int step = 0; step < 64; ++step) {
    textbook_step(tableau, system, h, q, v, lambda);
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    ASSERT_LE((stepper->configuration() - q).norm(), 1e-13) << step;
    ASSERT_LE((stepper->velocity() - v).norm(), 1e-13) << step;
    // Round-off of v, a few eps, times m / (h w) with w = 1/23, the smallest weight of a v'_i that follows.
    ASSERT_NEAR(stepper->multipliers()(0), lambda, 64 * eps * 2.0 * 23.0 / h) << step;
  }
}

TEST(HalfExplicit, IsTheTextbookMethodInALinearSpace) {
  expect_the_textbook_method(herk_three, Tableau::herk3);
  expect_the_textbook_method(herk_four, Tableau::herk4);
  expect_the_textbook_method(hedop_five, Tableau::hedop5);
}

// --- orders -----------------------------------------------------------------------------------------------------------------

TEST(HalfExplicit, HasItsOrdersOnTheConstrainedTop) {
  for (const Options& options : all_options()) {
    const ConvergenceOrders expected = orders(options.tableau);
    const Errors seen = observed_orders<HalfExplicit, ExtendedR3xSO3>(options);
    EXPECT_NEAR(seen.q, expected.q, order_tolerance) << text(options);
    EXPECT_NEAR(seen.v, expected.v, order_tolerance) << text(options);
    EXPECT_NEAR(seen.lambda, expected.lambda, order_tolerance) << text(options);
    EXPECT_NEAR(seen.largest_q, expected.q, order_tolerance) << text(options);
    EXPECT_NEAR(seen.largest_v, expected.v, order_tolerance) << text(options);
    EXPECT_NEAR(seen.largest_lambda, expected.lambda, order_tolerance) << text(options);
  }
}

// A particle without forces at the distance r = (1 + t / 2)^{-1/2} from the origin, in Cartesian coordinates, Phi =
// (x^2 + y^2 - r^2) / 2, or in polar ones, Phi = r - r(t), whose mass matrix depends on q. Its angle is t + t^2 / 4,
// for r^2 phi' = 1 is conserved.
template <Scalar T, bool polar>
class ReeledInParticle {
 public:
  using Scalar = T;
  using Group = RealSpace<T, 2>;
  template <class U>
  using rebind = ReeledInParticle<U, polar>;
  static constexpr int constraints = 1;
  static constexpr bool constant_mass = !polar;
  using Vector = Eigen::Matrix<T, 2, 1>;
  using Matrix = Eigen::Matrix<T, 2, 2>;
  using Lambda = Eigen::Matrix<T, 1, 1>;

  template <class U>
  rebind<U> cast() const {
    return {};
  }
  Matrix mass_matrix(const Vector& q) const {
    Matrix M = Matrix::Identity();
    if constexpr (polar) M(1, 1) = q(0) * q(0);
    return M;
  }
  Vector momentum(const Vector& q, const Vector& w) const { return mass_matrix(q) * w; }
  Vector force(const T&, const Vector& q, const Vector& v) const {
    if constexpr (polar) return {-q(0) * v(1) * v(1), T(2.0) * q(0) * v(0) * v(1)};
    return Vector::Constant(T(0.0));
  }
  // Of implicit methods.
  Matrix damping(const T&, const Vector&, const Vector&) const { return Matrix::Constant(T(0.0)); }
  Matrix stiffness(const T&, const Vector&, const Vector&, const Vector&, const Lambda&) const {
    return Matrix::Constant(T(0.0));
  }
  T energy(const Vector& q, const Vector& v) const { return v.dot(momentum(q, v)) * T(0.5); }
  T angular_momentum(const Vector&, const Vector&) const { return T(1.0); }
  Vector initial_configuration() const { return point(T(0.0)).q; }
  Vector initial_velocity() const { return point(T(0.0)).v; }

  Lambda constraint(const T& t, const Vector& q) const {
    if constexpr (polar) return Lambda(q(0) - radius(t));
    return Lambda((q.squaredNorm() - radius(t) * radius(t)) * T(0.5));
  }
  Eigen::Matrix<T, 1, 2> constraint_gradient(const Vector& q) const {
    if constexpr (polar) return {T(1.0), T(0.0)};
    return q.transpose();
  }
  Vector constraint_force(const Vector& q, const Lambda& lambda) const {
    return constraint_gradient(q).transpose() * lambda;
  }
  Lambda constraint_rate(const T& t, const Vector& q, const Vector& v) const {
    const T r = radius(t), rate = r * r * r * T(-0.25);
    return Lambda(constraint_gradient(q) * v) - Lambda(polar ? rate : T(r * rate));
  }
  Lambda constraint_curvature(const T& t, const Vector&, const Vector& v) const {
    const T r = radius(t), cube = r * r * r;
    if constexpr (polar) return Lambda(-cube * r * r * T(0.1875));
    return Lambda(v.squaredNorm() - cube * cube * T(0.25));
  }

  // The motion at t: u = 1 + t / 2, r' = -r^3 / 4, r'' = 3/16 r^5, r phi'^2 - r'' = lambda or r lambda.
  using Point = PointOfSolution<T, Vector, Vector, Lambda>;
  Point point(const T& t) const {
    using std::cos;
    using std::sin;
    const T u = T(1.0) + t * T(0.5), angle = t + t * t * T(0.25);
    const T r = radius(t), rate = r * r * r * T(-0.25);
    Point p;
    p.t = t;
    p.lambda(0) = r * u * u - r * r * r * r * r * T(0.1875);
    p.q = {r, angle};
    p.v = {rate, u};
    p.acceleration.setConstant(T(0.0));  // not asked for
    if constexpr (!polar) {
      p.lambda /= r;
      p.q = Vector(r * cos(angle), r * sin(angle));
      p.v = Vector(rate * cos(angle) - r * u * sin(angle), rate * sin(angle) + r * u * cos(angle));
    }
    return p;
  }

 private:
  static T radius(const T& t) {
    using std::sqrt;
    return T(1.0) / sqrt(T(1.0) + t * T(0.5));
  }
};

template <bool polar>
std::array<double, 3> reeling_errors(const Options& options, int steps) {
  using S = ReeledInParticle<Extended, polar>;
  const S system;
  const Extended h = Extended(1.0) / double(steps);
  const auto stepper = held_stepper<HalfExplicit, S>(options, system);
  const std::array points{system.point(Extended(0.0))};
  EXPECT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int n = 0; n < steps; ++n) {
    EXPECT_EQ(stepper->step().outcome, Outcome::ok);
    const Extended t = stepper->time();
    const auto rate = system.constraint_rate(t, stepper->configuration(), stepper->velocity());
    EXPECT_LE(std::abs(to_double(rate(0))), 1e-30) << text(options) << ", step " << n;
    const double phi = to_double(system.constraint(t, stepper->configuration())(0));
    EXPECT_LE(std::abs(phi), options.projection ? 1e-31 : 1e-6) << text(options) << ", step " << n;
  }
  const auto exact = system.point(Extended(1.0));
  return {to_double((stepper->configuration() - exact.q).norm()),
          to_double((stepper->velocity() - exact.v).norm()),
          to_double((stepper->multipliers() - exact.lambda).norm())};
}

TEST(HalfExplicit, HasItsOrdersWhereTheConstraintMoves) {
  for (const Options& options : all_options()) {
    const ConvergenceOrders expected = orders(options.tableau);
    const auto seen = [&]<bool polar>(std::bool_constant<polar>) {
      const auto coarse = reeling_errors<polar>(options, 2048), fine = reeling_errors<polar>(options, 4096);
      std::array<double, 3> order;
      for (std::size_t i = 0; i < 3; ++i) order[i] = std::log2(coarse[i] / fine[i]);
      return order;
    };
    const auto polar = seen(std::true_type{}), cartesian = seen(std::false_type{});
    EXPECT_NEAR(polar[0], expected.q, order_tolerance) << text(options);
    EXPECT_NEAR(polar[1], expected.v, order_tolerance) << text(options);
    EXPECT_NEAR(polar[2], expected.lambda, order_tolerance) << text(options);
    EXPECT_NEAR(cartesian[0], expected.q, order_tolerance) << text(options);
    EXPECT_NEAR(cartesian[1], expected.v, order_tolerance) << text(options);
    // The h^4 of HEDOP5 is small here: 4.3, falling.
    EXPECT_GE(cartesian[2], expected.lambda - order_tolerance) << text(options);
    EXPECT_LE(cartesian[2], expected.v) << text(options);
  }
}

// --- constraints ------------------------------------------------------------------------------------------------------------

// |B v| / |v| and |Phi| after every step of the slow top over 1/2 s.
struct Drift {
  double rate = 0.0, phi = 0.0;
};

template <template <class> class System, class T>
Drift largest_drift(const Options& options, int steps) {
  using S = System<T>;
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const auto stepper = held_stepper<HalfExplicit, S>(options, system);
  const std::array points{HeavyTopMotion(p, 0.1).point(system, Extended(0.0))};
  EXPECT_EQ(stepper->start(T(0.5) / T(double(steps)), points).outcome, Outcome::ok);
  Drift drift;
  for (int n = 0; n < steps; ++n) {
    EXPECT_EQ(stepper->step().outcome, Outcome::ok) << text(options) << ", step " << n;
    const auto& q = stepper->configuration();
    const auto& v = stepper->velocity();
    const T rate = constraint_product(system, q, v).norm() / v.norm();
    drift.rate = std::max(drift.rate, to_double(rate));
    drift.phi = std::max(drift.phi, to_double(T(system.constraint(q).norm())));
  }
  return drift;
}

template <template <class> class System>
void expect_constraints_to_round_off() {
  for (const Options& options : all_options()) {
    const Drift rounded = largest_drift<System, double>(options, 128);
    EXPECT_LE(rounded.rate, 32 * eps) << text(options);
    const Drift extended = largest_drift<System, Extended>(options, 128);
    EXPECT_LE(extended.rate, 32 * 5e-32) << text(options);
    EXPECT_LE(rounded.phi, options.projection ? 16 * eps : 1e-5) << text(options);
    EXPECT_LE(extended.phi, options.projection ? 16 * 5e-32 : 1e-5) << text(options);
  }
}

TEST(HalfExplicit, KeepsTheHiddenConstraintToRoundOffAndWithProjectionBoth) {
  expect_constraints_to_round_off<HeavyTopR3xSO3>();
  expect_constraints_to_round_off<HeavyTopSE3>();
}

TEST(HalfExplicit, DriftsFromTheConstraintByTheErrorOfTheMethod) {
  for (const Tableau tableau : all_tableaus) {
    const double coarse = largest_drift<HeavyTopR3xSO3, Extended>({tableau}, 1024).phi;
    const double fine = largest_drift<HeavyTopR3xSO3, Extended>({tableau}, 2048).phi;
    EXPECT_NEAR(std::log2(coarse / fine), orders(tableau).q, order_tolerance) << int(tableau);
  }
}

TEST(HalfExplicit, DoesNotDriftWhereTheConstraintIsASubgroup) {
  // Rotations about the tip are one of SE(3): B(q) is the same in all of them, and where every V_i fulfils B V_i = 0,
  // so does every Theta_i. V_2 does where v'_1 is v'_s of the step before, and the given multipliers of the first step
  // are consistent.
  for (const Tableau tableau : {Tableau::herk4, Tableau::hedop5}) {
    EXPECT_LE((largest_drift<HeavyTopSE3, double>({tableau}, 128).phi), 128 * 4 * eps) << int(tableau);
    EXPECT_LE((largest_drift<HeavyTopSE3, Extended>({tableau}, 128).phi), 128 * 4 * 5e-32) << int(tableau);
  }
  EXPECT_GE((largest_drift<HeavyTopSE3, Extended>({Tableau::herk3}, 128).phi), 1e-14);
}

TEST(HalfExplicit, ProjectsByTheLeastChangeInTheNormOfTheMass) {
  using S = HeavyTopR3xSO3<Extended>;
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const std::array points{HeavyTopMotion(p, 0.1).point(system, Extended(0.0))};
  for (const Tableau tableau : all_tableaus) {
    std::vector<std::unique_ptr<AnyStepper<S>>> steppers;
    for (const bool projection : {false, true}) {
      steppers.push_back(held_stepper<HalfExplicit, S>({tableau, projection}, system));
      ASSERT_EQ(steppers.back()->start(Extended(1.0 / 32), points).outcome, Outcome::ok);
      ASSERT_EQ(steppers.back()->step().outcome, Outcome::ok);
    }
    const auto& from = steppers[0]->configuration();
    const auto& to = steppers[1]->configuration();
    const Velocity<S> delta = S::Group::log(S::Group::compose(S::Group::inverse(from), to));
    const Velocity<S> change = steppers[1]->velocity() - steppers[0]->velocity();
    ASSERT_GE(to_double(delta.norm()), 1e-12);
    // M-orthogonal to what the constraint allows, at the configuration from which the change begins. The angle of a
    // difference as small as delta is known to 1e-32 / |delta|.
    NoAudit audit;
    RandomNumbers random(6);
    const auto expect_least = [&](const Velocity<S>& x, const Configuration<S>& q) {
      for (int i = 0; i < 4; ++i) {
        const Velocity<S> any = random.vector<6>().cast<Extended>();
        const auto w =
            solve_saddle_point(system, q, system.momentum(q, any), zero_multipliers(system), audit)->x;
        const double scale = to_double(system.momentum(q, x).norm() * w.norm());
        EXPECT_LE(std::abs(to_double(Extended(system.momentum(q, x).dot(w)))), scale * 1e-28 + 1e-29)
            << int(tableau);
      }
    };
    expect_least(delta, from);
    expect_least(change, to);
  }
}

// --- the state ----------------------------------------------------------------------------------------------------------------

TEST(HalfExplicit, AStepDependsOnNothingButTheState) {
  using S = HeavyTopR3xSO3<double>;
  const S system(slow_top());
  for (const Options& options : all_options()) {
    const auto running = make_stepper<HalfExplicit, S>(options, system);
    const auto again = make_stepper<HalfExplicit, S>(options, system);
    std::array points{HeavyTopMotion(slow_top(), 0.1).point(system, Extended(0.0))};
    constexpr double h = 1.0 / 64;
    ASSERT_EQ(running->start(h, points).outcome, Outcome::ok);
    for (int n = 0; n < 20; ++n) {
      points[0].t = running->time();
      points[0].q = running->configuration();
      points[0].v = running->velocity();
      points[0].lambda = running->multipliers();
      ASSERT_EQ(again->start(h, points).outcome, Outcome::ok);
      ASSERT_EQ(running->step().outcome, Outcome::ok);
      ASSERT_EQ(again->step().outcome, Outcome::ok);
      // v'_s of a stage and v'_1 from its multipliers differ by round-off of the forces, 1e3 eps; so do the
      // multipliers, which have that of v / h, too.
      EXPECT_LE((again->velocity() - running->velocity()).norm(), 1e3 * h * eps) << text(options);
      EXPECT_LE(S::Group::separation(again->configuration(), running->configuration()).norm(), 1e3 * h * eps)
          << text(options);
      EXPECT_LE((again->multipliers() - running->multipliers()).norm(), 1e5 * eps) << text(options);
    }
  }
}

TEST(HalfExplicit, CountsOneForceAndOneMatrixAStage) {
  using S = Audited<HeavyTopR3xSO3<Counted>>;
  const S system(slow_top());
  const std::array<std::uint64_t, 3> forces{3, 4, 6}, matrices{2, 4, 6};
  for (std::size_t i = 0; i < all_tableaus.size(); ++i) {
    const auto stepper = held_stepper<HalfExplicit, S>({all_tableaus[i]}, system);
    SolutionPoint<S> point;
    point.t = 0.0;
    point.q = system.initial_configuration();
    point.v = system.initial_velocity();
    point.lambda.setConstant(0.0);
    ASSERT_EQ(stepper->start(Counted(1.0 / 128), std::array{point}).outcome, Outcome::ok);
    EXPECT_EQ(stepper->audit().factorizations, 1u);
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    const SystemCalls before = SystemCalls::counts();
    const KernelAudit audit = stepper->audit();
    ASSERT_EQ(stepper->advance(10).outcome, Outcome::ok);
    EXPECT_EQ((SystemCalls::counts() - before).forces, 10 * forces[i]);
    EXPECT_EQ((SystemCalls::counts() - before).stiffnesses, 0u);
    EXPECT_EQ(stepper->audit().factorizations - audit.factorizations, 10 * matrices[i]);
    EXPECT_EQ(stepper->audit().factorizations_start, 1u);
    EXPECT_EQ(stepper->audit().iterations, 0u);
  }
}

// --- failures -------------------------------------------------------------------------------------------------------------------

// A step that fails changes nothing, and fails again.
template <MechanicalSystem S>
void expect_failure(const Options& options, const S& system, double h, const Multipliers<S>& lambda,
                    Outcome expected) {
  const auto stepper = make_stepper<HalfExplicit, S>(options, system);
  const SolutionPoint<S> point{0.0, system.initial_configuration(), system.initial_velocity(),
                               zero_velocity(system), lambda};
  ASSERT_EQ(stepper->start(h, std::array{point}).outcome, Outcome::ok);
  for (int attempt = 0; attempt < 2; ++attempt) {
    EXPECT_EQ(name(stepper->step().outcome), name(expected)) << text(options);
    EXPECT_EQ(stepper->time(), 0.0);
    EXPECT_EQ(S::Group::stacked(stepper->configuration()), S::Group::stacked(point.q));
    EXPECT_EQ(stepper->velocity(), point.v);
    EXPECT_EQ(stepper->multipliers(), lambda);
  }
}

TEST(HalfExplicit, SaysThatTheMatrixIsSingularWhereAConstraintIsRedundant) {
  using S = Particle<double, RedundantConstraint>;
  for (const Options& options : all_options())
    for (const double mass : {1.0, 3.0, 7.0, 49.0})
      expect_failure<S>(options, S(mass), 0.125, Eigen::Vector2d(0.0, 0.0), Outcome::singular_matrix);
}

TEST(HalfExplicit, SaysThatAMassIsNone) {
  using S = Pendulum;
  for (const Options& options : all_options())
    expect_failure<S>(options, S(0.0), 0.125, Eigen::Matrix<double, 1, 1>(1.0), Outcome::singular_matrix);
}

TEST(HalfExplicit, SaysThatAForceIsNoNumber) {
  using S = Pendulum;
  for (const Options& options : all_options())
    for (const ParticleForce force : {ParticleForce::no_number, ParticleForce::infinite})
      expect_failure<S>(options, S(1.0, force), 0.125, Eigen::Matrix<double, 1, 1>(1.0), Outcome::non_finite);
}

TEST(HalfExplicit, SaysThatAStepTurnsTooFar) {
  using S = HeavyTopR3xSO3<double>;
  HeavyTopParameters p = slow_top();
  p.angular_velocity = {0.0, 45.0, 0.0};
  for (const Options& options : all_options())
    expect_failure<S>(options, S(p), 0.1, Eigen::Vector3d(0.0, 0.0, 0.0), Outcome::rotation_too_large);
}

}  // namespace
}  // namespace liebench::half_explicit_test
