#include "integrators/bliedf2nd.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <concepts>
#include <numbers>
#include <utility>
#include <vector>

#include "groups/extended.h"
#include "integrators/list.h"
#include "problems/heavy_top.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"

namespace liebench {
namespace {

static_assert(std::same_as<Integrators, IntegratorList<BLieDF2nd, GeneralizedAlpha>>);

template <class T>
double unit() {
  return to_double(Eigen::NumTraits<T>::epsilon());
}

// Calls f.template operator()<k>() for every k of the method.
template <class F>
void for_every_k(const F& f) {
  f.template operator()<1>();
  f.template operator()<2>();
  f.template operator()<3>();
  f.template operator()<4>();
}

template <int k, MechanicalSystem S>
using Stepper = BLieDF2nd::Stepper<k, S>;

// k + 1 exact points at 0, h, ..., k h.
template <int k, MechanicalSystem S>
std::array<SolutionPoint<S>, k + 1> exact_points(const S& system, const HeavyTopMotion& motion,
                                                 const typename S::Scalar& h) {
  std::array<SolutionPoint<S>, k + 1> points;
  for (int j = 0; j <= k; ++j) points[std::size_t(j)] = motion.point(system, Extended(h) * double(j));
  return points;
}

// --- what one step is ------------------------------------------------------------------------------------

// Eqs. (20) and (23) term by term, from the states alone: q_j, v_j, lambda_j in, the defects of (20b), (20c) and
// (23d) out. The method's own bookkeeping (differences, histories) does not enter.
template <int k, MechanicalSystem S>
class StepLaw {
 public:
  using T = typename S::Scalar;
  using Group = typename S::Group;

  StepLaw(const S& system, const T& h, bool correction) : system_(system), h_(h), correction_(correction) {}

  void push(const Configuration<S>& q, const Velocity<S>& v) {
    q_.insert(q_.begin(), q);
    v_.insert(v_.begin(), v);
  }

  // sum gamma_i Dq_{n+1-i} - v_{n+1} - h^2 L_k
  Velocity<S> kinematics() const {
    const auto c = bdf_coefficients<k, T>();
    Velocity<S> sum = -v_[0];
    for (std::size_t i = 1; i <= std::size_t(k); ++i)
      sum += c.gamma[i - 1] * (Group::log(Group::compose(Group::inverse(q_[i]), q_[i - 1])) / h_);
    if (!correction_) return sum;
    // Eq. (22); v_[1] is v_n.
    if constexpr (k == 3)
      sum -= h_ * Group::commutator(v_[1], (T(3.0) * v_[1] - T(4.0) * v_[2] + v_[3]) / T(2.0)) / T(12.0);
    if constexpr (k == 4)
      sum -= h_ *
             Group::commutator(v_[1],
                               (T(7.0) * v_[1] - T(7.0) * v_[2] - T(3.0) * v_[3] + T(3.0) * v_[4]) / T(4.0)) /
             T(12.0);
    return sum;
  }

  // M sum alpha_i v_{n+1-i} + h (g + B^T lambda)
  Velocity<S> dynamics(const T& t, const Multipliers<S>& lambda) const {
    const auto c = bdf_coefficients<k, T>();
    Velocity<S> sum = Velocity<S>::Constant(T(0.0));
    for (std::size_t i = 0; i <= std::size_t(k); ++i) sum += c.alpha[i] * v_[i];
    Velocity<S> defect = system_.momentum(q_[0], sum) + h_ * system_.force(t, q_[0], v_[0]);
    if constexpr (S::constraints > 0) defect += h_ * system_.constraint_force(q_[0], lambda);
    return defect;
  }

 private:
  S system_;
  T h_;
  bool correction_;
  std::vector<Configuration<S>> q_;
  std::vector<Velocity<S>> v_;
};

template <int k, MechanicalSystem S>
void expect_steps_satisfy_the_equations(const HeavyTopParameters& p, const BLieDF2nd::Options& options) {
  using T = typename S::Scalar;
  const S system(p);
  const T h(1.0 / 128);
  constexpr int steps = 40;
  const HeavyTopMotion motion(p, 0.5);
  const auto points = exact_points<k, S>(system, motion, h);
  Stepper<k, S> stepper(system, options);
  ASSERT_EQ(stepper.start(h, points).outcome, Outcome::ok);

  StepLaw<k, S> law(system, h, options.correction);
  // Eq. (56) moves every starting velocity by the same vector, which the last of them shows.
  const Velocity<S> moved = stepper.velocity() - points[std::size_t(k - 1)].v;
  for (int j = 0; j < k; ++j) law.push(points[std::size_t(j)].q, points[std::size_t(j)].v + moved);

  // Logarithms are known to eps, increments to eps / h, and the acceleration's sum to eps |v|; differences
  // accumulate them over the steps. Where a constraint rules the increment its round-off is eps |q| / h.
  const double speed = 1 + to_double(stepper.velocity().norm());
  const double mass = to_double(VelocityMatrix<S>(system.mass_matrix(points[0].q)).norm());
  const double kinematic = 64 * steps * unit<T>() * (speed + 2 / to_double(h));
  const double dynamic = 64 * steps * unit<T>() * mass * (speed + 2 / to_double(h));
  for (int n = k; n < k + steps; ++n) {
    ASSERT_EQ(stepper.step().outcome, Outcome::ok) << n;
    law.push(stepper.configuration(), stepper.velocity());
    EXPECT_LE(to_double(law.kinematics().norm()), kinematic) << "k = " << k << ", step " << n;
    EXPECT_LE(to_double(law.dynamics(stepper.time(), stepper.multipliers()).norm()), dynamic)
        << "k = " << k << ", step " << n;
    if constexpr (S::constraints > 0) {
      EXPECT_LE(to_double(system.constraint(stepper.configuration()).norm()), 64 * unit<T>()) << n;
    }
    EXPECT_LE(std::abs(to_double(T(stepper.time() - T(double(n)) * h))), 1e-15);
  }
}

template <class S>
void expect_every_method_satisfies_its_equations() {
  for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(2)})
    for (const bool correction : {true, false}) {
      const auto check = [&]<int k>() {
        expect_steps_satisfy_the_equations<k, S>(p, {.k = k, .correction = correction});
      };
      for_every_k(check);
    }
}

TEST(BLieDF2nd, StepsSatisfyEquation20) {
  expect_every_method_satisfies_its_equations<HeavyTopSO3<double>>();
  expect_every_method_satisfies_its_equations<HeavyTopSO3<Extended>>();
}

TEST(BLieDF2nd, StepsSatisfyEquation23) {
  expect_every_method_satisfies_its_equations<HeavyTopR3xSO3<double>>();
  expect_every_method_satisfies_its_equations<HeavyTopR3xSO3<Extended>>();
}

TEST(BLieDF2nd, StepsSatisfyEquation23FromModifiedStartingVelocities) {
  for (const bool correction : {true, false}) {
    const auto check = [&]<int k>() {
      expect_steps_satisfy_the_equations<k, HeavyTopR3xSO3<Extended>>(
          unsymmetric_top(2), {.k = k, .correction = correction, .modified_start = true});
    };
    for_every_k(check);
  }
}

// Eq. (56) by hand: [M B^T; B 0] [Dv; .] = [0; B l / h] at q_{k-1}.
TEST(BLieDF2nd, ModifiedStartIsThatOfEquation56) {
  using S = HeavyTopR3xSO3<Extended>;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const Extended h(1.0 / 64);
  const HeavyTopMotion motion(p, 0.2);
  const auto check = [&]<int k>() {
    const auto points = exact_points<k, S>(system, motion, h);
    Stepper<k, S> stepper(system, {.k = k, .modified_start = true});
    ASSERT_EQ(stepper.start(h, points).outcome, Outcome::ok);
    const Velocity<S> moved = stepper.velocity() - points[std::size_t(k - 1)].v;
    StepLaw<k, S> law(system, h, true);
    for (const SolutionPoint<S>& point : points) law.push(point.q, point.v);
    const Velocity<S> local_error = law.kinematics();
    const auto& q = points[std::size_t(k - 1)].q;
    const auto B = system.constraint_gradient(q);
    // B Dv = B l / h, and M Dv in the range of B^T: orthogonal to what B maps to zero.
    const double scale = unit<Extended>() * 1e4 / to_double(h);
    EXPECT_LE(to_double((B * (moved - local_error)).norm()), scale) << k;
    const auto admissible = motion.point(system, h * double(k - 1)).v;
    EXPECT_LE(std::abs(to_double(Extended(system.momentum(q, moved).dot(admissible)))), 100 * scale) << k;
    EXPECT_GT(to_double(moved.norm()), 1e-12) << k;
  };
  for_every_k(check);
}

// --- exact solutions -------------------------------------------------------------------------------------

// A body that spins about a principal axis under no forces: v is constant, q(t) = q_0 exp(t v).
template <int k, class T>
void expect_constant_velocity_is_exact(const HeavyTopParameters& p, double step_size, int steps) {
  using S = HeavyTopSO3<T>;
  using Group = typename S::Group;
  const S system(p);
  const T h(step_size);
  const Velocity<S> omega = system.initial_velocity();
  std::array<SolutionPoint<S>, k + 1> points;
  for (int j = 0; j <= k; ++j)
    points[std::size_t(j)] = {
        h * T(double(j)),
        Group::compose(system.initial_configuration(), Group::exp(omega * T(h * T(double(j))))),
        omega,
        Velocity<S>::Constant(T(0.0)),
        {}};
  for (const bool correction : {true, false}) {
    Stepper<k, S> stepper(system, {.k = k, .correction = correction});
    ASSERT_EQ(stepper.start(h, points).outcome, Outcome::ok);
    for (int n = k; n <= steps; ++n) ASSERT_EQ(stepper.step().outcome, Outcome::ok);
    // Starting increments carry eps / h; the velocity keeps what they and each step's solve leave of it, some
    // eps |v|, and the attitude is the sum of all increments.
    const double speed = to_double(omega.norm());
    const double velocity_error = 64 * unit<T>() * (speed + 1 / step_size) * std::sqrt(double(steps));
    EXPECT_LE(to_double((stepper.velocity() - omega).norm()), velocity_error) << k;
    const T end = stepper.time();
    const auto expected = Group::compose(system.initial_configuration(), Group::exp(omega * end));
    EXPECT_LE(to_double((stepper.configuration() - expected).norm()),
              steps * (step_size * velocity_error + 16 * unit<T>()))
        << k;
  }
}

TEST(BLieDF2nd, ConstantVelocityGivesTheExponentialExactly) {
  HeavyTopParameters spinning;
  spinning.gravity = {0, 0, 0};
  spinning.angular_velocity = {0, 150, 0};
  spinning.orientation = {0.8, -0.1, 0.5, 0.3};
  HeavyTopParameters sphere = spinning;  // any axis
  sphere.center_of_mass = {0, 0, 0};
  sphere.inertia = {{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}};
  sphere.angular_velocity = {3, -5, 2};
  const auto check = [&]<int k>() {
    expect_constant_velocity_is_exact<k, double>(spinning, 1e-3, 400);
    expect_constant_velocity_is_exact<k, Extended>(spinning, 1e-3, 400);
    expect_constant_velocity_is_exact<k, double>(sphere, 0.02, 400);
  };
  for_every_k(check);
}

// --- linear spaces ---------------------------------------------------------------------------------------

// The classical BDF method for second-order equations in increment form, eq. (11): unknown Dq_n,
//   sum gamma_i Dq_{n+1-i} = v_{n+1},   M sum alpha_i v_{n+1-i} = -h g(t_{n+1}, q_n + h Dq_n, v_{n+1})
template <int k, int n>
struct ClassicalBdf {
  using S = Oscillators<double, n>;
  using Vector = Eigen::Matrix<double, n, 1>;

  S system;
  double h, t;
  Vector q;
  std::vector<Vector> increments, velocities;  // newest first

  void step() {
    const auto c = bdf_coefficients<k, double>();
    const double t_new = t + h;
    Vector x = velocities[0];
    for (int iteration = 0; iteration < 12; ++iteration) {
      const Vector q_new = q + h * x;
      const Vector v = velocity(x);
      Vector sum = c.alpha[0] * v;
      for (std::size_t i = 1; i <= std::size_t(k); ++i) sum += c.alpha[i] * velocities[i - 1];
      const Vector residual = system.mass_matrix(q) * sum + h * system.force(t_new, q_new, v);
      const Eigen::Matrix<double, n, n> J = c.alpha[0] * c.gamma[0] * system.mass_matrix(q) +
                                            h * c.gamma[0] * system.damping(t_new, q_new, v) +
                                            h * h * system.stiffness(t_new, q_new, v, v, {});
      x -= J.fullPivLu().solve(residual);
    }
    velocities.insert(velocities.begin(), velocity(x));
    increments.insert(increments.begin(), x);
    q += h * x;
    t = t_new;
  }

 private:
  Vector velocity(const Vector& x) const {
    const auto c = bdf_coefficients<k, double>();
    Vector v = c.gamma[0] * x;
    for (std::size_t i = 2; i <= std::size_t(k); ++i) v += c.gamma[i - 1] * increments[i - 2];
    return v;
  }
};

template <int k, int n>
void expect_classical_bdf() {
  using S = Oscillators<double, n>;
  using Vector = Eigen::Matrix<double, n, 1>;
  const S system;
  const double h = 1.0 / 32;  // exact, so that both count the same times
  // Any starting values: both methods continue them.
  std::array<SolutionPoint<S>, k + 1> points;
  for (int j = 0; j <= k; ++j)
    points[std::size_t(j)] = {j * h,
                              system.initial_configuration() + system.initial_velocity() * std::sin(j * h),
                              system.initial_velocity() * std::cos(j * h),
                              Vector::Zero(),
                              {}};
  ClassicalBdf<k, n> classical{system, h, (k - 1) * h, points[std::size_t(k - 1)].q, {}, {}};
  for (std::size_t j = 0; j < std::size_t(k); ++j) {
    classical.velocities.insert(classical.velocities.begin(), points[j].v);
    if (j > 0) {
      const Vector increment = (points[j].q - points[j - 1].q) / h;
      classical.increments.insert(classical.increments.begin(), increment);
    }
  }
  Stepper<k, S> stepper(system, {.k = k});
  ASSERT_EQ(stepper.start(h, points).outcome, Outcome::ok);
  for (int step = 1; step <= 64; ++step) {
    ASSERT_EQ(stepper.step().outcome, Outcome::ok);
    classical.step();
    // Both round each step to a few eps, in increments to eps |q| / h; a BDF method passes errors on without
    // growth (k <= 2) or with a factor below ten (k = 3, 4).
    const double tolerance = 16 * 2.3e-16 * step * (1 + 1 / h);
    EXPECT_LE((stepper.velocity() - classical.velocities[0]).norm(), tolerance) << k << ' ' << step;
    EXPECT_LE((stepper.configuration() - classical.q).norm(), tolerance) << k << ' ' << step;
    EXPECT_EQ(stepper.time(), classical.t);
  }
}

TEST(BLieDF2nd, IsTheClassicalBdfMethodOnALinearSpace) {
  const auto check = []<int k>() {
    expect_classical_bdf<k, 1>();
    expect_classical_bdf<k, 4>();
  };
  for_every_k(check);
}

// --- orders ----------------------------------------------------------------------------------------------

template <int k, class S>
Errors observed_orders(const BLieDF2nd::Options& options) {
  return liebench::observed_orders<Stepper<k, S>>(options);
}

using Rotation = HeavyTopSO3<Extended>;
using Body = HeavyTopR3xSO3<Extended>;

TEST(BLieDF2nd, HasOrderKInConfigurationAndVelocity) {
  const auto check = []<int k>() {
    const Errors order = observed_orders<k, Rotation>({.k = k});
    EXPECT_NEAR(order.q, k, order_tolerance);
    EXPECT_NEAR(order.v, k, order_tolerance);
  };
  for_every_k(check);
}

TEST(BLieDF2nd, HasOrderKInConfigurationVelocityAndMultipliers) {
  const auto check = []<int k>() {
    const Errors order = observed_orders<k, Body>({.k = k});
    EXPECT_NEAR(order.q, k, order_tolerance);
    EXPECT_NEAR(order.v, k, order_tolerance);
    EXPECT_NEAR(order.lambda, k, order_tolerance);
  };
  for_every_k(check);
}

TEST(BLieDF2nd, HasOrderTwoOnlyWithoutItsCorrection) {
  // A correction of the wrong sign has this order too: with L_k the orders above are above two.
  const auto check = []<int k>() {
    const Errors rotation = observed_orders<k, Rotation>({.k = k, .correction = false});
    EXPECT_NEAR(rotation.q, 2, order_tolerance) << k;
    EXPECT_NEAR(rotation.v, 2, order_tolerance) << k;
    const Errors body = observed_orders<k, Body>({.k = k, .correction = false});
    EXPECT_NEAR(body.q, 2, order_tolerance) << k;
    EXPECT_NEAR(body.v, 2, order_tolerance) << k;
    EXPECT_NEAR(body.lambda, 2, order_tolerance) << k;
  };
  check.operator()<3>();
  check.operator()<4>();
}

TEST(BLieDF2nd, LosesOneOrderOfLambdaInTheTransientPhase) {
  const auto check = []<int k>() {
    EXPECT_NEAR((observed_orders<k, Body>({.k = k}).largest_lambda), k - 1, order_tolerance) << k;
  };
  check.operator()<2>();
  check.operator()<3>();
  check.operator()<4>();
}

TEST(BLieDF2nd, KeepsTheOrderOfLambdaFromModifiedStartingVelocities) {
  const auto check = []<int k>() {
    const Errors order = observed_orders<k, Body>({.k = k, .modified_start = true});
    EXPECT_NEAR(order.largest_lambda, k, order_tolerance) << k;
    EXPECT_NEAR(order.q, k, order_tolerance) << k;
    EXPECT_NEAR(order.v, k, order_tolerance) << k;
    EXPECT_NEAR(order.lambda, k, order_tolerance) << k;
  };
  check.operator()<2>();
  check.operator()<3>();
  check.operator()<4>();
}

TEST(BLieDF2nd, TheCorrectionChangesNothingForOneAndTwoSteps) {
  // L_1 = L_2 = 0: the same numbers to the last bit.
  using S = HeavyTopR3xSO3<double>;
  const HeavyTopParameters p = slow_top();
  const HeavyTopMotion motion(p, 0.3);
  const auto check = [&]<int k>() {
    const S system(p);
    const auto points = exact_points<k, S>(system, motion, 0.01);
    Stepper<k, S> with(system, {.k = k, .correction = true}), without(system, {.k = k, .correction = false});
    with.start(0.01, points);
    without.start(0.01, points);
    for (int n = 0; n < 20; ++n) {
      with.step();
      without.step();
      EXPECT_EQ(with.configuration().second, without.configuration().second);
      EXPECT_EQ(with.multipliers(), without.multipliers());
    }
  };
  check.operator()<1>();
  check.operator()<2>();
}

// --- outcomes --------------------------------------------------------------------------------------------

TEST(BLieDF2nd, StopsWhereAStepTurnsByPiOrMore) {
  // |Omega| = 150 rad/s, nothing but spin: a step of 0.03 s turns by 4.5 rad, one of 0.02 s by 3.
  HeavyTopParameters p;
  p.gravity = {0, 0, 0};
  p.angular_velocity = {0, 150, 0};
  using S = HeavyTopSO3<double>;
  const S system(p);
  for (const double h : {0.02, 0.03}) {
    std::array<SolutionPoint<S>, 2> points;
    for (int j = 0; j < 2; ++j)
      points[std::size_t(j)] = {j * h,
                                SO3<double>::exp(j * h * system.initial_velocity()),
                                system.initial_velocity(),
                                Eigen::Vector3d::Zero(),
                                {}};
    Stepper<1, S> stepper(system, {.k = 1});
    ASSERT_EQ(stepper.start(h, points).outcome, Outcome::ok);
    const Eigen::Matrix3d before = stepper.configuration();
    EXPECT_EQ(stepper.step().outcome, h * 150 < std::numbers::pi ? Outcome::ok : Outcome::rotation_too_large);
    if (h * 150 >= std::numbers::pi) {
      // A step that failed is not taken.
      EXPECT_EQ(stepper.time(), 0.0);
      EXPECT_EQ(stepper.configuration(), before);
    }
  }
}

template <class S>
std::array<SolutionPoint<S>, 3> straight_points(const S& system, double h) {
  std::array<SolutionPoint<S>, 3> points;
  for (int j = 0; j < 3; ++j)
    points[std::size_t(j)] = {j * h, system.initial_configuration() + j * h * system.initial_velocity(),
                              system.initial_velocity(), Velocity<S>::Zero(), Multipliers<S>::Zero()};
  return points;
}

template <class S>
Outcome first_step(const S& system, double h) {
  Stepper<2, S> stepper(system, {.k = 2});
  EXPECT_EQ(stepper.start(h, straight_points(system, h)).outcome, Outcome::ok);
  const Outcome outcome = stepper.step().outcome;
  EXPECT_EQ(stepper.time(), h);  // t_{k-1}: the step was not taken
  return outcome;
}

TEST(BLieDF2nd, ReportsARedundantConstraintAsSingular) {
  using S = Particle<double, RedundantConstraint>;
  for (const double mass : {1.0, 3.0, 7.0})
    EXPECT_EQ(first_step(S(mass), 0.1), Outcome::singular_matrix) << mass;
  // The starting procedure of eq. (56) meets it first.
  const S system;
  Stepper<2, S> stepper(system, {.k = 2, .modified_start = true});
  EXPECT_EQ(stepper.start(0.1, straight_points(system, 0.1)).outcome, Outcome::singular_matrix);
}

TEST(BLieDF2nd, ReportsForcesThatAreNoNumbers) {
  EXPECT_EQ(first_step(Particle<double, NanForce>(), 0.1), Outcome::non_finite);
  EXPECT_EQ(first_step(Particle<double, InfiniteForce>(), 0.1), Outcome::non_finite);
}

TEST(BLieDF2nd, ReportsAConstraintWithoutSolutionAsDivergence) {
  EXPECT_EQ(first_step(Particle<double, ImpossibleConstraint>(), 0.1), Outcome::newton_diverged);
}

// --- small steps -----------------------------------------------------------------------------------------

// The fast top in double where Phi / h and the increments are known to eps / h only: 2e-10 and 2e-9.
TEST(BLieDF2nd, EndsAtTheRoundOffFloorAtTinyStepsInsteadOfFailing) {
  using S = HeavyTopR3xSO3<double>;
  const HeavyTopParameters p;
  const S system(p);
  const HeavyTopMotion motion(p, 0.001);
  const auto check = [&]<int k>() {
    for (const double h : {1e-6, 1e-7}) {
      Stepper<k, S> stepper(system, {.k = k});
      ASSERT_EQ(stepper.start(h, exact_points<k, S>(system, motion, h)).outcome, Outcome::ok);
      for (int n = 0; n < 20000; ++n) {
        const StepResult result = stepper.step();
        ASSERT_EQ(result.outcome, Outcome::ok) << "k = " << k << ", h = " << h << ", step " << n;
      }
      EXPECT_LE(system.constraint(stepper.configuration()).norm(), 64 * 2.3e-16) << k << ' ' << h;
      EXPECT_TRUE(stepper.multipliers().allFinite());
    }
  };
  for_every_k(check);
}

// --- reproducibility -------------------------------------------------------------------------------------

template <class S>
void expect_same_bits() {
  using T = typename S::Scalar;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const HeavyTopMotion motion(p, 0.2);
  const T h(0.01);
  const auto points = exact_points<4, S>(system, motion, h);
  const BLieDF2nd::Options options{.k = 4, .modified_start = S::constraints > 0};
  Stepper<4, S> first(system, options);
  first.start(h, points);
  for (int n = 0; n < 200; ++n) first.step();
  Stepper<4, S> second(system, options);
  second.start(h, points);
  for (int n = 0; n < 200; ++n) second.step();
  const auto same = [](const auto& a, const auto& b) {
    bool equal = true;
    for (Eigen::Index i = 0; i < a.size(); ++i) equal = equal && a(i) == b(i);
    return equal;
  };
  EXPECT_TRUE(same(S::Group::stacked(first.configuration()), S::Group::stacked(second.configuration())));
  EXPECT_TRUE(same(first.velocity(), second.velocity()));
  EXPECT_TRUE(same(first.multipliers(), second.multipliers()));
}

TEST(BLieDF2nd, GivesTheSameBitsTwice) {
  expect_same_bits<HeavyTopSO3<double>>();
  expect_same_bits<HeavyTopR3xSO3<double>>();
  expect_same_bits<HeavyTopR3xSO3<Extended>>();
}

TEST(BLieDF2nd, CountingChangesNoBit) {
  using S = HeavyTopR3xSO3<double>;
  const HeavyTopParameters p = slow_top();
  const S system(p);
  const HeavyTopMotion motion(p, 0.2);
  const auto points = exact_points<3, S>(system, motion, 0.01);
  BLieDF2nd::Stepper<3, S, NoAudit> clean(system, {.k = 3});
  BLieDF2nd::Stepper<3, S, KernelAudit> counted(system, {.k = 3});
  clean.start(0.01, points);
  counted.start(0.01, points);
  for (int n = 1; n <= 50; ++n) {
    clean.step();
    counted.step();
    EXPECT_EQ(clean.configuration().second, counted.configuration().second);
    EXPECT_EQ(clean.multipliers(), counted.multipliers());
    EXPECT_GE(counted.audit().solves, std::uint64_t(n));
  }
}

// --- options ---------------------------------------------------------------------------------------------

TEST(BLieDF2nd, OptionListHasTheDefaultsOfTheOptions) {
  const BLieDF2nd::Options defaults;
  for (const OptionInfo& info : BLieDF2nd::option_list) {
    if (info.name == "k") {
      EXPECT_EQ(info.fallback, defaults.k);
      EXPECT_EQ(info.least, 1);
      EXPECT_EQ(info.most, 4);
    }
    if (info.name == "correction") {
      EXPECT_EQ(info.fallback != 0, defaults.correction);
    }
    if (info.name == "modified_start") {
      EXPECT_EQ(info.fallback != 0, defaults.modified_start);
    }
    EXPECT_FALSE(info.meaning.empty()) << info.name;
  }
}

TEST(BLieDF2nd, OptionsSelectTheStepper) {
  const HeavyTopSO3<double> system{HeavyTopParameters{}};
  for (int k = 1; k <= 4; ++k) {
    OptionValues values;
    values.set("k", k);
    values.set("correction", false);
    values.set("modified_start", true);
    values.set("form", std::string("index3"));
    const BLieDF2nd::Options options = BLieDF2nd::options(values);
    EXPECT_EQ(options.k, k);
    EXPECT_FALSE(options.correction);
    EXPECT_TRUE(options.modified_start);
    const int steps = BLieDF2nd::with_stepper<HeavyTopSO3<double>, NoAudit>(
        options, system, [](const auto& stepper) { return std::decay_t<decltype(stepper)>::steps; });
    EXPECT_EQ(steps, k);
  }
}

}  // namespace
}  // namespace liebench
