#include "integrators/bliedf2nd.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "groups/extended.h"
#include "integrators/list.h"
#include "problems/heavy_top.h"
#include "tests/support/dense_algebra.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"
#include "tests/support/step_law.h"
#include "tests/support/steppers.h"

namespace liebench::bliedf2nd_test {
namespace {

constexpr int most_steps = 6;
constexpr std::array corrections{Correction::none, Correction::explicit_term, Correction::implicit_term};

template <class T>
double unit() {
  return to_double(Eigen::NumTraits<T>::epsilon());
}

template <MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> make(const S& system, const BLieDF2nd::Options& options) {
  return make_stepper<BLieDF2nd, S>(options, system);
}

std::string text(const BLieDF2nd::Options& options) {
  const std::array words{"none", "explicit", "implicit"};
  return "k = " + std::to_string(options.k) + ", correction " + words[std::size_t(options.correction)] +
         (options.form == Form::index3 ? "" : ", stabilized");
}

// --- what one step is ------------------------------------------------------------------------------------

// Power series in the backward difference nabla, up to nabla^6.
template <class T>
using Series = std::array<T, 7>;

template <class T>
Series<T> product(const Series<T>& a, const Series<T>& b) {
  Series<T> c;
  c.fill(T(0.0));
  for (std::size_t i = 0; i < c.size(); ++i)
    for (std::size_t j = 0; i + j < c.size(); ++j) c[i + j] = c[i + j] + a[i] * b[j];
  return c;
}

// Eqs. (20) and (23) term by term, and L_k of eq. (22); for k = 5, 6 and the implicit form, which the paper does not have,
// the five brackets of integrators/lie_correction.h written out, with derivatives by the calculus of differences.
template <MechanicalSystem S>
class StepLaw : public BdfStepLaw<S> {
  using Base = BdfStepLaw<S>;

 public:
  using typename Base::Group;
  using typename Base::T;

  StepLaw(const S& system, const T& h, const BLieDF2nd::Options& options)
      : Base(options.k, system, h), correction_(options.correction) {}

  // sum gamma_i Dq_{n+1-i} - v_{n+1} - h^2 L_k
  Velocity<S> kinematics() const {
    Velocity<S> sum = -Base::v(0);
    for (int i = 1; i <= Base::k(); ++i) sum += Base::gamma(i) * Base::increment(i - 1);
    return sum - scaled_correction();
  }

 private:
  // h^2 L_k
  Velocity<S> scaled_correction() const {
    const auto v = [&](int i) { return Base::v(i); };
    const T h = Base::h();
    const int k = Base::k();
    const bool implicit = correction_ == Correction::implicit_term;
    if (correction_ == Correction::none || k < 3) return Velocity<S>::Constant(T(0.0));
    const auto bracket = [](const Velocity<S>& x, const Velocity<S>& y) { return Group::commutator(x, y); };
    if (k <= 4) {
      if (implicit) {
        // v_{n+1} and h v'_{n+1} = sum alpha_i v_{n+1-i}
        Velocity<S> a = Velocity<S>::Constant(T(0.0));
        for (int i = 0; i <= k; ++i) a += Base::alpha(i) * v(i);
        return h * bracket(v(0), a) / T(12.0);
      }
      Velocity<S> a;
      if (k == 3) a = (T(3.0) * v(1) - T(4.0) * v(2) + v(3)) / T(2.0);
      if (k == 4) a = (T(7.0) * v(1) - T(7.0) * v(2) - T(3.0) * v(3) + T(3.0) * v(4)) / T(4.0);
      return h * bracket(v(1), a) / T(12.0);
    }
    // h D = -log(1 - nabla). Implicit: its powers on v_{n+1}, up to nabla^k. Explicit: those times the shift
    // E = 1 / (1 - nabla) on v_n, up to nabla^(k-1).
    Series<T> D, term;
    for (std::size_t j = 0; j < D.size(); ++j) {
      D[j] = j > 0 ? T(1.0) / T(double(j)) : T(0.0);
      term[j] = implicit && j > 0 ? T(0.0) : T(1.0);
    }
    std::vector<Velocity<S>> derivatives;  // h^d times the derivatives d = 0, ..., 3 of v at t_{n+1}
    for (int d = 0; d <= 3; ++d) {
      derivatives.push_back(implicit ? apply(term, 0, k) : apply(term, 1, k - 1));
      term = product<T>(term, D);
    }
    const Velocity<S>&V = derivatives[0], &a = derivatives[1], &b = derivatives[2], &c = derivatives[3];
    Velocity<S> sum = h / T(12.0) * bracket(V, a);
    sum -= h / T(720.0) * bracket(V, c);
    sum -= h / T(180.0) * bracket(a, b);
    sum += h * h / T(720.0) * bracket(V, bracket(V, b));
    sum -= h * h / T(240.0) * bracket(a, bracket(V, a));
    sum -= h * h * h / T(720.0) * bracket(V, bracket(V, bracket(V, a)));
    return sum;
  }

  // sum_j s_j nabla^j v(newest)
  Velocity<S> apply(const Series<T>& s, int newest, int degree) const {
    Velocity<S> sum = Velocity<S>::Constant(T(0.0));
    for (int j = 0; j <= degree; ++j) {
      double binomial = 1.0;
      for (int i = 0; i <= j; ++i) {
        sum += (s[std::size_t(j)] * T(binomial)) * Base::v(newest + i);
        binomial = -binomial * (j - i) / (i + 1);
      }
    }
    return sum;
  }

  Correction correction_;
};

template <class S>
void expect_steps_satisfy_the_equations(const HeavyTopParameters& p, const BLieDF2nd::Options& options) {
  using T = typename S::Scalar;
  const S system(p);
  const T h(1.0 / 128);
  constexpr int steps = 40;
  const HeavyTopMotion motion(p, 0.5);
  const auto stepper = make(system, options);
  const int k = options.k;
  const auto points = exact_starting_points(system, motion, h, stepper->starting_points());
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);

  StepLaw<S> law(system, h, options);
  // Eq. (56) moves every starting velocity by the same vector, which the last of them shows.
  const Velocity<S> moved = stepper->velocity() - points[std::size_t(k - 1)].v;
  for (int j = 0; j < k; ++j) law.push(points[std::size_t(j)].q, points[std::size_t(j)].v + moved);

  // Logarithms are known to eps, increments to eps / h, and the acceleration's sum to eps |v|; differences
  // accumulate them over the steps. Where a constraint rules the increment its round-off is eps |q| / h.
  const double speed = 1 + to_double(stepper->velocity().norm());
  const double mass = to_double(VelocityMatrix<S>(system.mass_matrix(points[0].q)).norm());
  const double kinematic = 64 * steps * unit<T>() * (speed + 2 / to_double(h));
  const double dynamic = 64 * steps * unit<T>() * mass * (speed + 2 / to_double(h));
  for (int n = k; n < k + steps; ++n) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok) << n;
    law.push(stepper->configuration(), stepper->velocity());
    Velocity<S> defect = law.kinematics();
    if constexpr (S::constraints > 0) {
      const auto& q = stepper->configuration();
      EXPECT_LE(to_double(system.constraint(q).norm()), 64 * unit<T>()) << text(options) << ", step " << n;
      if (options.form == Form::stabilized_index2) {
        // The velocity is known to what the increments are.
        const Multipliers<S> hidden = system.constraint_gradient(q) * stepper->velocity();
        EXPECT_LE(to_double(hidden.norm()), 64 * unit<T>() * (speed + 1 / to_double(h)))
            << text(options) << ", step " << n;
        defect = law.without_auxiliary_multiplier(defect);
      }
    }
    EXPECT_LE(to_double(defect.norm()), kinematic) << text(options) << ", step " << n;
    EXPECT_LE(to_double(law.dynamics(stepper->time(), stepper->multipliers()).norm()), dynamic)
        << text(options) << ", step " << n;
    EXPECT_LE(std::abs(to_double(T(stepper->time() - T(double(n)) * h))), 1e-15);
  }
}

template <class S>
void expect_every_method_satisfies_its_equations() {
  for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(2)})
    for (const Form form : {Form::index3, Form::stabilized_index2}) {
      if (S::constraints == 0 && form != Form::index3) continue;
      for (const Correction correction : corrections)
        for (int k = 1; k <= most_steps; ++k)
          expect_steps_satisfy_the_equations<S>(p, {.k = k, .correction = correction, .form = form});
    }
}

TEST(BLieDF2nd, StepsSatisfyEquation20) {
  expect_every_method_satisfies_its_equations<HeavyTopSO3<double>>();
  expect_every_method_satisfies_its_equations<ExtendedSO3>();
}

TEST(BLieDF2nd, StepsSatisfyEquation23) {
  expect_every_method_satisfies_its_equations<HeavyTopR3xSO3<double>>();
  expect_every_method_satisfies_its_equations<ExtendedR3xSO3>();
}

TEST(BLieDF2nd, StepsSatisfyEquation23FromModifiedStartingVelocities) {
  for (const Correction correction : corrections)
    for (int k = 1; k <= most_steps; ++k)
      expect_steps_satisfy_the_equations<ExtendedR3xSO3>(
          unsymmetric_top(2), {.k = k, .correction = correction, .modified_start = true});
}

TEST(BLieDF2nd, EveryOneOfManyStepsIsSolvedToRoundOff) {
  // Long enough for the Newton matrix to be made anew and to age many times, with predictions of all qualities.
  const HeavyTopParameters p = slow_top();
  const ExtendedR3xSO3 system(p);
  const Extended h(1.0 / 4096);
  const HeavyTopMotion motion(p, 0.1);
  for (const Form form : {Form::index3, Form::stabilized_index2})
    for (const int k : {2, 4, 6}) {
      const BLieDF2nd::Options options{.k = k, .correction = Correction::implicit_term, .form = form};
      const auto stepper = make(system, options);
      const auto points = exact_starting_points(system, motion, h, k + 1);
      ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
      StepLaw<ExtendedR3xSO3> law(system, h, options);
      for (int j = 0; j < k; ++j) law.push(points[std::size_t(j)].q, points[std::size_t(j)].v);
      // Where it stalls the kernel may stop 32 units of eps |q| / h short (integrators/newton.h), and M h v' is
      // gamma_1^2 M d.
      const double mass = to_double(VelocityMatrix<ExtendedR3xSO3>(system.mass_matrix(points[0].q)).norm());
      const double slope = to_double(law.gamma(1) * law.gamma(1));
      const double tolerance = 64 * unit<Extended>() * slope * mass / to_double(h);
      for (int n = k; n <= 2048; ++n) {
        ASSERT_EQ(stepper->step().outcome, Outcome::ok) << text(options) << ", step " << n;
        law.push(stepper->configuration(), stepper->velocity());
        ASSERT_LE(to_double(law.dynamics(stepper->time(), stepper->multipliers()).norm()), tolerance)
            << text(options) << ", step " << n;
      }
    }
}

// Eq. (56) by hand: [M B^T; B 0] [Dv; .] = [0; B l / h] at q_{k-1}.
TEST(BLieDF2nd, ModifiedStartIsThatOfEquation56) {
  using S = ExtendedR3xSO3;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const Extended h(1.0 / 64);
  const HeavyTopMotion motion(p, 0.2);
  for (const Correction correction : corrections)
    for (int k = 1; k <= most_steps; ++k) {
      const BLieDF2nd::Options options{.k = k, .correction = correction, .modified_start = true};
      const auto stepper = make(system, options);
      const auto points = exact_starting_points(system, motion, h, k + 1);
      ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
      const Velocity<S> moved = stepper->velocity() - points[std::size_t(k - 1)].v;
      StepLaw<S> law(system, h, options);
      for (const SolutionPoint<S>& point : points) law.push(point.q, point.v);
      const Velocity<S> local_error = law.kinematics();
      const auto& q = points[std::size_t(k - 1)].q;
      const auto B = system.constraint_gradient(q);
      // B Dv = B l / h, and M Dv in the range of B^T: orthogonal to what B maps to zero.
      const double scale = unit<Extended>() * 1e4 / to_double(h);
      // An implicit L_k is taken at the v_k of the kinematic equation, which is l / h from the exact one: a relative
      // change of l by at most h |v|, of higher order.
      const bool implicit = correction == Correction::implicit_term && k >= 3;
      const double higher = to_double(h * points[0].v.norm() * local_error.norm() * B.norm());
      EXPECT_LE(to_double((B * (moved - local_error)).norm()), scale + (implicit ? higher : 0.0))
          << text(options);
      const auto admissible = motion.point(system, h * double(k - 1)).v;
      EXPECT_LE(std::abs(to_double(Extended(system.momentum(q, moved).dot(admissible)))), 100 * scale)
          << text(options);
      EXPECT_GT(to_double(moved.norm()), 1e-12) << text(options);
    }
}

// --- exact solutions -------------------------------------------------------------------------------------

// A body that spins about a principal axis under no forces: v is constant, q(t) = q_0 exp(t v).
template <class T>
void expect_constant_velocity_is_exact(const HeavyTopParameters& p, double step_size, int steps) {
  using S = HeavyTopSO3<T>;
  using Group = typename S::Group;
  const S system(p);
  const T h(step_size);
  const Velocity<S> omega = system.initial_velocity();
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j <= most_steps; ++j)
    points.push_back({h * T(double(j)),
                      Group::compose(system.initial_configuration(), Group::exp(omega * T(h * T(double(j))))),
                      omega,
                      Velocity<S>::Constant(T(0.0)),
                      {}});
  for (const Correction correction : corrections)
    for (int k = 1; k <= most_steps; ++k) {
      const BLieDF2nd::Options options{.k = k, .correction = correction};
      const auto stepper = make(system, options);
      ASSERT_EQ(stepper->start(h, std::span(points).first(std::size_t(k + 1))).outcome, Outcome::ok);
      for (int n = k; n <= steps; ++n) ASSERT_EQ(stepper->step().outcome, Outcome::ok);
      // Starting increments carry eps / h; the velocity keeps what they and each step's solve leave of it, some
      // eps |v|, and the attitude is the sum of all increments.
      const double speed = to_double(omega.norm());
      const double velocity_error = 64 * unit<T>() * (speed + 1 / step_size) * std::sqrt(double(steps));
      EXPECT_LE(to_double((stepper->velocity() - omega).norm()), velocity_error) << text(options);
      const T end = stepper->time();
      const auto expected = Group::compose(system.initial_configuration(), Group::exp(omega * end));
      EXPECT_LE(to_double((stepper->configuration() - expected).norm()),
                steps * (step_size * velocity_error + 16 * unit<T>()))
          << text(options);
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
  expect_constant_velocity_is_exact<double>(spinning, 1e-3, 400);
  expect_constant_velocity_is_exact<Extended>(spinning, 1e-3, 400);
  expect_constant_velocity_is_exact<double>(sphere, 0.02, 400);
}

// --- linear spaces ---------------------------------------------------------------------------------------

// The classical BDF method for second-order equations in increment form, eq. (11): unknown Dq_n,
//   sum gamma_i Dq_{n+1-i} = v_{n+1},   M sum alpha_i v_{n+1-i} = -h g(t_{n+1}, q_n + h Dq_n, v_{n+1})
template <int n>
struct ClassicalBdf {
  using S = Oscillators<double, n>;
  using Vector = Eigen::Matrix<double, n, 1>;

  S system;
  std::vector<double> alpha, gamma;
  double h, t;
  Vector q;
  std::vector<Vector> increments, velocities;  // newest first

  void step() {
    const double t_new = t + h;
    Vector x = velocities[0];
    for (int iteration = 0; iteration < 12; ++iteration) {
      const Vector q_new = q + h * x;
      const Vector v = velocity(x);
      Vector sum = alpha[0] * v;
      for (std::size_t i = 1; i < alpha.size(); ++i) sum += alpha[i] * velocities[i - 1];
      const Vector residual = system.mass_matrix(q) * sum + h * system.force(t_new, q_new, v);
      const Eigen::Matrix<double, n, n> J = alpha[0] * gamma[0] * system.mass_matrix(q) +
                                            h * gamma[0] * system.damping(t_new, q_new, v) +
                                            h * h * system.stiffness(t_new, q_new, v, v, {});
      x -= dense_solution(J, residual);
    }
    velocities.insert(velocities.begin(), velocity(x));
    increments.insert(increments.begin(), x);
    q += h * x;
    t = t_new;
  }

 private:
  Vector velocity(const Vector& x) const {
    Vector v = gamma[0] * x;
    for (std::size_t i = 2; i <= gamma.size(); ++i) v += gamma[i - 1] * increments[i - 2];
    return v;
  }
};

template <int n>
void expect_classical_bdf(int k) {
  using S = Oscillators<double, n>;
  using Vector = Eigen::Matrix<double, n, 1>;
  const S system;
  const double h = 1.0 / 32;  // exact, so that both count the same times
  // Any starting values: both methods continue them.
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j <= k; ++j)
    points.push_back({j * h,
                      system.initial_configuration() + system.initial_velocity() * std::sin(j * h),
                      system.initial_velocity() * std::cos(j * h),
                      Vector::Zero(),
                      {}});
  const BdfStepLaw<S> law(k, system, h);
  ClassicalBdf<n> classical{system, {}, {}, h, (k - 1) * h, points[std::size_t(k - 1)].q, {}, {}};
  for (int i = 0; i <= k; ++i) classical.alpha.push_back(law.alpha(i));
  for (int i = 1; i <= k; ++i) classical.gamma.push_back(law.gamma(i));
  for (std::size_t j = 0; j < std::size_t(k); ++j) {
    classical.velocities.insert(classical.velocities.begin(), points[j].v);
    if (j > 0) {
      const Vector increment = (points[j].q - points[j - 1].q) / h;
      classical.increments.insert(classical.increments.begin(), increment);
    }
  }
  const auto stepper = make(system, {.k = k});
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int step = 1; step <= 64; ++step) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    classical.step();
    // Both round each step to a few eps, in increments to eps |q| / h; a BDF method passes errors on without
    // growth (k <= 2) or with a factor below ten (k >= 3).
    const double tolerance = 16 * 2.3e-16 * step * (1 + 1 / h);
    EXPECT_LE((stepper->velocity() - classical.velocities[0]).norm(), tolerance) << k << ' ' << step;
    EXPECT_LE((stepper->configuration() - classical.q).norm(), tolerance) << k << ' ' << step;
    EXPECT_EQ(stepper->time(), classical.t);
  }
}

TEST(BLieDF2nd, IsTheClassicalBdfMethodOnALinearSpace) {
  for (int k = 1; k <= most_steps; ++k) {
    expect_classical_bdf<1>(k);
    expect_classical_bdf<4>(k);
  }
}

TEST(BLieDF2nd, TheCorrectionChangesNothingForOneAndTwoSteps) {
  // L_1 = L_2 = 0: the same numbers to the last bit.
  using S = HeavyTopR3xSO3<double>;
  const HeavyTopParameters p = slow_top();
  const HeavyTopMotion motion(p, 0.3);
  const S system(p);
  for (const int k : {1, 2})
    for (const Correction correction : {Correction::explicit_term, Correction::implicit_term}) {
      const auto points = exact_starting_points(system, motion, 0.01, k + 1);
      const auto with = make(system, {.k = k, .correction = correction});
      const auto without = make(system, {.k = k, .correction = Correction::none});
      with->start(0.01, points);
      without->start(0.01, points);
      for (int n = 0; n < 20; ++n) {
        EXPECT_EQ(with->step().outcome, Outcome::ok);
        EXPECT_EQ(without->step().outcome, Outcome::ok);
        EXPECT_EQ(with->configuration().second, without->configuration().second);
        EXPECT_EQ(with->multipliers(), without->multipliers());
      }
    }
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
    const auto stepper = make(system, {.k = 1});
    ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
    const Eigen::Matrix3d before = stepper->configuration();
    EXPECT_EQ(stepper->step().outcome,
              h * 150 < std::numbers::pi ? Outcome::ok : Outcome::rotation_too_large);
    if (h * 150 >= std::numbers::pi) {
      // A step that failed is not taken.
      EXPECT_EQ(stepper->time(), 0.0);
      EXPECT_EQ(stepper->configuration(), before);
    }
  }
}

// --- small steps -----------------------------------------------------------------------------------------

// The fast top in double where Phi / h and the increments are known to eps / h only: 2e-10 and 2e-9.
TEST(BLieDF2nd, EndsAtTheRoundOffFloorAtTinyStepsInsteadOfFailing) {
  using S = HeavyTopR3xSO3<double>;
  const HeavyTopParameters p;
  const S system(p);
  const HeavyTopMotion motion(p, 0.001);
  for (const Correction correction : {Correction::explicit_term, Correction::implicit_term})
    for (int k = 1; k <= most_steps; ++k)
      for (const double h : {1e-6, 1e-7}) {
        const BLieDF2nd::Options options{.k = k, .correction = correction};
        const auto stepper = make(system, options);
        const auto points = exact_starting_points(system, motion, h, stepper->starting_points());
        ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
        for (int n = 0; n < 20000; ++n)
          ASSERT_EQ(stepper->step().outcome, Outcome::ok) << text(options) << ", h = " << h << ", step " << n;
        EXPECT_LE(system.constraint(stepper->configuration()).norm(), 64 * 2.3e-16)
            << text(options) << ", h = " << h;
        EXPECT_TRUE(stepper->multipliers().allFinite());
      }
}

}  // namespace
}  // namespace liebench::bliedf2nd_test
