#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include "integrators/dense_inverse.h"
#include "integrators/gauss.h"
#include "integrators/gauss_coefficients.h"
#include "problems/linear_oscillator.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"

namespace liebench::gauss_test {
namespace {

constexpr int most_stages = GaussCoefficients<double>::most_stages;
constexpr double eps = std::numeric_limits<double>::epsilon();

// --- coefficients: the simplifying assumptions B(2s), C(s), D(s) [Hairer, Norsett & Wanner, Solving ODE I, II.7] ------------------

Extended power(const Extended& x, int k) {
  Extended value(1.0);
  for (int i = 0; i < k; ++i) value *= x;
  return value;
}

Extended sum_over(int s, const std::function<Extended(std::size_t)>& term) {
  Extended sum(0.0);
  for (int i = 0; i < s; ++i) sum += term(std::size_t(i));
  return sum;
}

double size_of(const Extended& x) {
  return std::abs(to_double(x));
}

// All sums are at most 1 and of at most 12 positive or alternating terms below 1: a few dozen units of 2^-104 = 5e-32.
constexpr double extended_round_off = 2e-30;

TEST(GaussCoefficients, FulfilTheSimplifyingAssumptions) {
  for (int s = 1; s <= most_stages; ++s) {
    const GaussCoefficients<Extended> g(s);
    const auto quadrature = [&](int k) {
      return sum_over(s, [&](std::size_t i) { return g.b[i] * power(g.c[i], k - 1); }) -
             Extended(1.0) / double(k);
    };
    for (int k = 1; k <= 2 * s; ++k) EXPECT_LE(size_of(quadrature(k)), extended_round_off) << s << ' ' << k;
    // The error of x^{2s} over [0, 1] is (s!)^4 / ((2s)!^2 (2s + 1)): the order is not higher.
    double error = 1.0 / (2 * s + 1);
    for (int i = 1; i <= s; ++i) error *= double(i * i) / double((s + i) * (s + i));
    EXPECT_NEAR(size_of(quadrature(2 * s + 1)), error, 1e-9 * error) << s;
    for (int k = 1; k <= s; ++k)
      for (std::size_t i = 0; i < std::size_t(s); ++i) {
        const Extended stage = sum_over(s, [&](std::size_t j) { return g.a[i][j] * power(g.c[j], k - 1); });
        EXPECT_LE(size_of(stage - power(g.c[i], k) / double(k)), extended_round_off) << s << ' ' << k;
        const Extended adjoint =
            sum_over(s, [&](std::size_t j) { return g.b[j] * power(g.c[j], k - 1) * g.a[j][i]; });
        EXPECT_LE(size_of(adjoint - g.b[i] * (Extended(1.0) - power(g.c[i], k)) / double(k)),
                  extended_round_off)
            << s << ' ' << k;
      }
  }
}

TEST(GaussCoefficients, AreSymmetricToTheLastBit) {
  for (int s = 1; s <= most_stages; ++s) {
    const GaussCoefficients<double> g(s);
    for (std::size_t i = 0; i < std::size_t(s); ++i) {
      const std::size_t mirror = std::size_t(s) - 1 - i;
      EXPECT_EQ(g.b[i], g.b[mirror]);
      for (std::size_t j = 0; j < std::size_t(s); ++j)
        EXPECT_EQ(g.centred[i][j], -g.centred[mirror][std::size_t(s) - 1 - j]) << s;
    }
  }
}

TEST(GaussCoefficients, InDoubleAreThoseOfExtendedPrecision) {
  for (int s = 1; s <= most_stages; ++s) {
    const GaussCoefficients<double> g(s);
    const GaussCoefficients<Extended> exact(s);
    for (std::size_t i = 0; i < std::size_t(s); ++i)
      for (std::size_t j = 0; j < std::size_t(s); ++j) {
        // Sums of s terms below 1 times b_j.
        EXPECT_LE(size_of(exact.a[i][j] - g.a[i][j]), 8 * s * eps * g.b[j]) << s;
        EXPECT_LE(size_of(exact.c[i] - g.c[i]), 2 * eps) << s;
      }
  }
}

TEST(GaussCoefficients, ExtrapolatePolynomialsOfDegreeBelowTheNumberOfStages) {
  for (int s = 1; s <= most_stages; ++s) {
    const GaussCoefficients<Extended> g(s);
    for (int k = 0; k < s; ++k)
      for (std::size_t i = 0; i < std::size_t(s); ++i) {
        const Extended next =
            sum_over(s, [&](std::size_t j) { return g.extrapolation[i][j] * power(g.c[j], k); });
        const Extended magnitude =
            sum_over(s, [&](std::size_t j) { return Extended(size_of(g.extrapolation[i][j])); });
        EXPECT_LE(size_of(next - power(Extended(1.0) + g.c[i], k)), extended_round_off * to_double(magnitude))
            << s << ' ' << k;
      }
  }
}

// --- the inverse ------------------------------------------------------------------------------------------------------------

TEST(DenseInverse, OfAMatrixThatNeedsPivots) {
  constexpr int n = 7;
  RandomNumbers random(3);
  Eigen::Matrix<double, n, n> A;
  for (int j = 0; j < n; ++j) A.col(j) = random.vector<n>();
  A(0, 0) = 0.0;
  A.row(3).swap(A.row(5));
  Eigen::Matrix<double, n, n> inverse = A;
  ASSERT_TRUE((invert<n>(inverse.data(), std::size_t(n))));
  const double condition = A.norm() * inverse.norm();
  EXPECT_LE((A * inverse - A.Identity()).norm(), n * eps * condition);
  EXPECT_LE((inverse * A - A.Identity()).norm(), n * eps * condition);
  Eigen::Matrix3d singular;
  singular << 1, 2, 3, 2, 4, 6, 1, 0, 1;
  EXPECT_FALSE((invert<3>(singular.data(), std::size_t(3))));
}

// --- linear spaces: the classical method ------------------------------------------------------------------------------------

// y' = f(t, y) by a tableau from the books, stage values by plain fixed-point iteration.
template <std::size_t s>
struct Tableau {
  std::array<std::array<double, s>, s> a;
  std::array<double, s> b, c;
};

template <std::size_t s>
void expect_the_classical_method(const Tableau<s>& tableau) {
  using S = Oscillators<double, 2>;
  using State = Eigen::Vector4d;
  const S system;
  constexpr double h = 1.0 / 16;
  const auto slope = [&](double t, const State& y) -> State {
    const Eigen::Vector2d q = y.head<2>(), v = y.tail<2>();
    State f;
    f << v, -system.mass_matrix(q).inverse() * system.force(t, q, v);
    return f;
  };
  State y;
  y << system.initial_configuration(), system.initial_velocity();
  const auto stepper = make_stepper<Gauss, S>({int(s)}, system);
  const State first = slope(0.0, y);
  const std::array points{SolutionPoint<S>{0.0, y.head<2>(), y.tail<2>(), first.tail<2>(), {}}};
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int step = 0; step < 64; ++step) {
    std::array<State, s> k;
    k.fill(State::Zero());
    for (int sweep = 0; sweep < 60; ++sweep)
      for (std::size_t i = 0; i < s; ++i) {
        State stage = y;
        for (std::size_t j = 0; j < s; ++j) stage += h * tableau.a[i][j] * k[j];
        k[i] = slope((step + tableau.c[i]) * h, stage);
      }
    for (std::size_t i = 0; i < s; ++i) y += h * tableau.b[i] * k[i];
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    ASSERT_LE((stepper->configuration() - y.head<2>()).norm(), 1e-14) << s << ' ' << step;
    ASSERT_LE((stepper->velocity() - y.tail<2>()).norm(), 1e-14) << s << ' ' << step;
  }
}

TEST(Gauss, IsTheClassicalMethodInALinearSpace) {
  expect_the_classical_method<1>({{{{0.5}}}, {1.0}, {0.5}});
  const double r = std::sqrt(3.0) / 6;
  expect_the_classical_method<2>({{{{0.25, 0.25 - r}, {0.25 + r, 0.25}}}, {0.5, 0.5}, {0.5 - r, 0.5 + r}});
  const double w = std::sqrt(15.0);
  expect_the_classical_method<3>({{{{5.0 / 36, 2.0 / 9 - w / 15, 5.0 / 36 - w / 30},
                                    {5.0 / 36 + w / 24, 2.0 / 9, 5.0 / 36 - w / 24},
                                    {5.0 / 36 + w / 30, 2.0 / 9 + w / 15, 5.0 / 36}}},
                                  {5.0 / 18, 4.0 / 9, 5.0 / 18},
                                  {0.5 - w / 10, 0.5, 0.5 + w / 10}});
}

// --- rotations --------------------------------------------------------------------------------------------------------------

TEST(Gauss, HasItsOrderOnRotations) {
  for (int s = 1; s <= 3; ++s) {
    const Errors order = observed_orders<Gauss, ExtendedSO3>({s});
    EXPECT_NEAR(order.q, 2 * s, order_tolerance);
    EXPECT_NEAR(order.v, 2 * s, order_tolerance);
  }
}

// Longer steps for higher orders, so that errors stay a hundred times above the round-off of so few steps, 1e-31. The error of a symmetric
// method has even powers of h alone: C h^p (1 + c h^2 + ...), and the order seen is p + 3/4 c h^2 log2(e): within 0.1 of p for c up to
// 1 |Omega|^2 in the longest steps, h |Omega| = 0.27.
TEST(Gauss, HasItsOrderOnRotationsUpToSixteen) {
  constexpr double end = 0.5;
  const HeavyTopParameters p = slow_top();
  const ExtendedSO3 system(p);
  const HeavyTopMotion motion(p, 0.6);
  for (const auto& [s, steps] :
       {std::pair(4, 32), std::pair(5, 24), std::pair(6, 16), std::pair(7, 16), std::pair(8, 8)}) {
    const auto errors = [&, s = s](int n) {
      return errors_at<ExtendedSO3>(end, n, motion, system, *make_stepper<Gauss, ExtendedSO3>({s}, system),
                                    Start::reference);
    };
    const Errors coarse = errors(steps), fine = errors(2 * steps);
    EXPECT_GE(fine.q, 1e-29) << s;
    EXPECT_NEAR(std::log2(coarse.q / fine.q), 2 * s, order_tolerance) << s;
    EXPECT_NEAR(std::log2(coarse.v / fine.v), 2 * s, order_tolerance) << s;
  }
}

// J (Omega_{n+1} - Omega_n) = -h g(q_n o exp(h/2 w~), w), q_{n+1} = q_n o exp(h w~), w = (Omega_n + Omega_{n+1}) / 2
TEST(Gauss, WithOneStageIsTheImplicitMidpointRule) {
  using S = HeavyTopSO3<double>;
  const HeavyTopParameters p = unsymmetric_top(4);
  const S system(p);
  constexpr double h = 1.0 / 32;
  const auto stepper = make_stepper<Gauss, S>({1}, system);
  const std::array points{HeavyTopMotion(p, 0.1).point(system, Extended(0.0))};
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int step = 0; step < 32; ++step) {
    const Eigen::Matrix3d q = stepper->configuration();
    const Eigen::Vector3d v = stepper->velocity();
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    const Eigen::Vector3d w = (v + stepper->velocity()) / 2;
    const Eigen::Vector3d impulse = h * system.force(0.0, q * SO3<double>::exp((0.5 * h * w).eval()), w) +
                                    system.momentum(q, stepper->velocity() - v);
    const double momentum = system.momentum(q, w).norm();
    EXPECT_LE(impulse.norm(), 8 * eps * momentum) << step;
    EXPECT_LE((stepper->configuration() - q * SO3<double>::exp((h * w).eval())).norm(), 16 * eps) << step;
  }
}

// Forth and back, in steps of up to 0.6 rad: what is left is the round-off of all steps, each of a few eps in R and eps |Omega| in Omega
// times the growth of errors over the motion, below 1e2. (In coordinates about q_n the errors of the two ways differ, for s = 2 by 2e-2.)
TEST(Gauss, IsSymmetricInTime) {
  using S = HeavyTopSO3<double>;
  const HeavyTopParameters p = unsymmetric_top(2);
  const S system(p);
  constexpr int steps = 64;
  const SolutionPoint<S> begin = HeavyTopMotion(p, 0.1).point(system, Extended(0.0));
  const double speed = begin.v.norm(), h = 0.6 / speed;
  for (int s = 1; s <= most_stages; ++s) {
    const auto stepper = make_stepper<Gauss, S>({s}, system);
    ASSERT_EQ(stepper->start(h, std::span(&begin, 1)).outcome, Outcome::ok);
    ASSERT_EQ(stepper->advance(steps).outcome, Outcome::ok) << s;
    const SolutionPoint<S> end{
        stepper->time(), stepper->configuration(), stepper->velocity(), begin.acceleration, {}};
    ASSERT_EQ(stepper->start(-h, std::span(&end, 1)).outcome, Outcome::ok);
    ASSERT_EQ(stepper->advance(steps).outcome, Outcome::ok) << s;
    const double round_off = 100 * 4 * eps * 2 * steps;
    EXPECT_LE((stepper->configuration() - begin.q).norm(), round_off) << s;
    EXPECT_LE((stepper->velocity() - begin.v).norm(), round_off * speed) << s;
  }
}

// The paper's top at t = 2 s in steps of 1.5 rad, against the closed form (docs/theory.md).
TEST(Gauss, FollowsTheFastTopToTheLastDigits) {
  using S = HeavyTopSO3<double>;
  const HeavyTopParameters p;
  const S system(p);
  const Eigen::Vector3d x(-0.1504168227456417598, -0.7241655916368956508, -0.6730222695604440961);
  const auto stepper = make_stepper<Gauss, S>({8}, system);
  const std::array points{HeavyTopMotion(p, 0.01).point(system, Extended(0.0))};
  ASSERT_EQ(stepper->start(0.01, points).outcome, Outcome::ok);
  ASSERT_EQ(stepper->advance(200).outcome, Outcome::ok);
  EXPECT_LE((stepper->configuration().col(1) - x).norm(), 1e-13);
}

// x'' = -omega^2 x: the stages of any h omega in a few turns, the energy kept (the method is symplectic, and conserves quadratic
// invariants); the stopping rule leaves up to 32 units of round-off of v in a step, 64 of the energy, and sums add as much at most.
TEST(Gauss, FollowsAStiffSpringAndKeepsItsEnergy) {
  using S = LinearOscillator<double>;
  constexpr int steps = 1000;
  for (const double h_omega : {1e-4, 0.1, 40.0, 1e4})
    for (const double h : {1e-4, 1.0})
      for (const int s : {1, 2, 4, 8}) {
        const double omega = h_omega / h;
        const S system(std::complex<double>(0.0, omega));
        const Eigen::Matrix<double, 1, 1> q = system.initial_configuration(), v = system.initial_velocity();
        const std::array points{SolutionPoint<S>{0.0, q, v, -system.force(0.0, q, v), {}}};
        const auto stepper = make_stepper<Gauss, S>({s}, system);
        ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
        ASSERT_EQ(stepper->advance(steps).outcome, Outcome::ok) << s << " stages, h omega = " << h_omega;
        const double energy = system.energy(stepper->configuration(), stepper->velocity());
        EXPECT_NEAR(energy / system.energy(q, v), 1.0, 128 * eps * steps)
            << s << " stages, h omega = " << h_omega << ", h = " << h;
      }
}

// --- failures ---------------------------------------------------------------------------------------------------------------

// x'' = -1e4 x^5: at x = 0.1 the matrices have a stiffness of 5, which is 5e8 where a step with v = 10 looks for its stages.
class HardeningSpring : public LinearOscillator<double> {
 public:
  using LinearOscillator<double>::LinearOscillator;
  Vector force(const double&, const Vector& q, const Vector&) const {
    return Vector::Constant(1e4 * q(0) * q(0) * q(0) * q(0) * q(0));
  }
};

TEST(Gauss, DivergesWhereItsMatricesAreNoneOfTheStepAndStaysWhereItIs) {
  using S = HardeningSpring;
  const S system(0.0, 0.0);
  for (const int s : {2, 4, 8}) {
    const auto stepper = make_stepper<Gauss, S>({s}, system);
    const Eigen::Matrix<double, 1, 1> q = Eigen::Matrix<double, 1, 1>::Constant(0.1),
                                      v = Eigen::Matrix<double, 1, 1>::Constant(10.0);
    const std::array points{SolutionPoint<S>{0.0, q, v, -system.force(0.0, q, v), {}}};
    ASSERT_EQ(stepper->start(1.0, points).outcome, Outcome::ok);
    EXPECT_EQ(stepper->step().outcome, Outcome::newton_diverged) << s;
    EXPECT_EQ(stepper->time(), 0.0);
    EXPECT_EQ(stepper->configuration(), q);
    EXPECT_EQ(stepper->velocity(), v);
  }
}

TEST(Gauss, DoesNotFitAConstrainedProblem) {
  EXPECT_EQ(any_stepper<HeavyTopR3xSO3<double>>(Gauss::Options{}, HeavyTopR3xSO3<double>(slow_top())),
            nullptr);
}

}  // namespace
}  // namespace liebench::gauss_test
