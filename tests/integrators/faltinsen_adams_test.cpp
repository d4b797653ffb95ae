#include "integrators/faltinsen_adams.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "integrators/fits.h"
#include "problems/heavy_top.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/large_turns.h"
#include "tests/support/observed_order.h"
#include "tests/support/small_systems.h"
#include "tests/support/steppers.h"

namespace liebench::faltinsen_adams_test {
namespace {

// --- coefficients ----------------------------------------------------------------------------------------

TEST(AdamsBashforth, IntegratesPolynomialsOfDegreeKMinusOneAndNoOthers) {
  // int_0^1 s^j ds = sum_i b_i (1 - i)^j
  for (int k = 1; k <= most_adams_steps; ++k)
    for (int j = 0; j <= k; ++j) {
      Extended sum(0.0), size(0.0);
      for (int i = 1; i <= k; ++i) {
        const Extended term = value_of<Extended>(adams_bashforth[std::size_t(k - 1)][std::size_t(i - 1)]) *
                              std::pow(double(1 - i), j);
        sum += term;
        size += abs(term);
      }
      const double defect = std::abs(to_double(sum - Extended(1.0) / double(j + 1)));
      if (j < k)
        EXPECT_LE(defect, 1e-31 * to_double(size)) << k << ' ' << j;
      else
        EXPECT_GT(defect, 0.1) << k;
    }
}

// --- linear spaces: the classical method -----------------------------------------------------------------

// y_{n+1} = y_n + h sum_{j<k} gamma_j nabla^j y'_n with the gamma_j of the generating function, sum_{i<=j} gamma_i / (j
// + 1 - i) = 1 [Hairer, Norsett & Wanner, Solving ODE I, III.1, (1.5), (1.7)].
template <int n>
class TextbookAdams {
 public:
  using Vector = Eigen::Matrix<double, n, 1>;

  explicit TextbookAdams(int k) {
    for (int j = 0; j < k; ++j) {
      double gamma = 1.0;
      for (int i = 0; i < j; ++i) gamma -= gamma_[std::size_t(i)] / (j + 1 - i);
      gamma_.push_back(gamma);
    }
  }
  void push(const Vector& rate) { rates_.insert(rates_.begin(), rate); }
  Vector change(double h) const {
    std::vector<Vector> differences = rates_;
    Vector sum = Vector::Zero();
    for (std::size_t j = 0; j < gamma_.size(); ++j) {
      sum += h * gamma_[j] * differences[0];
      for (std::size_t i = 0; i + 1 < differences.size(); ++i) differences[i] -= differences[i + 1];
    }
    return sum;
  }

 private:
  std::vector<double> gamma_;
  std::vector<Vector> rates_;
};

TEST(FaltinsenAdams, IsTheClassicalMethodInALinearSpace) {
  constexpr int n = 2;
  using S = Oscillators<double, n>;
  const S system;
  // Small: explicit methods of six steps are stable next to 0 only.
  constexpr double h = 1.0 / 64;
  for (int k = 1; k <= most_adams_steps; ++k) {
    std::vector<SolutionPoint<S>> points;
    TextbookAdams<n> q_law(k), v_law(k);
    const auto push = [&](double t, const Eigen::Vector2d& q, const Eigen::Vector2d& v) {
      q_law.push(v);
      v_law.push(-system.mass_matrix(q).inverse() * system.force(t, q, v));
    };
    for (int j = 0; j < k; ++j) {
      const double t = j * h;
      points.push_back({t,
                        system.initial_configuration() + system.initial_velocity() * std::sin(t),
                        system.initial_velocity() * std::cos(t),
                        Eigen::Vector2d::Zero(),
                        {}});
      if (j + 1 < k) push(t, points.back().q, points.back().v);
    }
    Eigen::Vector2d q = points.back().q, v = points.back().v;
    const auto stepper = make_stepper<FaltinsenAdams, S>({.k = k}, system);
    ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
    for (int step = k; step < k + 128; ++step) {
      push((step - 1) * h, q, v);
      q += q_law.change(h);
      v += v_law.change(h);
      ASSERT_EQ(stepper->step().outcome, Outcome::ok);
      // sum |b_i| < 22, |v| and |v'| below 4, each term rounded a few times: 128 steps of 4 * 22 * 4 h eps.
      ASSERT_LE((stepper->configuration() - q).norm(), 2e-13) << k << ", step " << step;
      ASSERT_LE((stepper->velocity() - v).norm(), 2e-13) << k << ", step " << step;
    }
  }
}

// --- what one step is ------------------------------------------------------------------------------------

// u = h sum b_i T^{-1}(log(q_n^{-1} q_{n+1-i})) v_{n+1-i} against log(q_n^{-1} q_{n+1}), from the states alone.
template <class S>
void expect_steps_satisfy_the_equations(int k, const HeavyTopParameters& p) {
  using T = typename S::Scalar;
  using Group = typename S::Group;
  const double unit = to_double(Eigen::NumTraits<T>::epsilon());
  const S system(p);
  const T h(1.0 / 64);
  const HeavyTopMotion motion(p, 0.2);
  const auto stepper = make_stepper<FaltinsenAdams, S>({.k = k}, system);
  auto points = exact_starting_points(system, motion, h, k);
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  for (int step = 0; step < 20; ++step) {
    const SolutionPoint<S>& last = points.back();
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    Velocity<S> u = Velocity<S>::Constant(T(0.0)), v = last.v;
    double size = 0.0;
    for (int i = 1; i <= k; ++i) {
      const SolutionPoint<S>& point = points[points.size() - std::size_t(i)];
      const T b = value_of<T>(adams_bashforth[std::size_t(k - 1)][std::size_t(i - 1)]);
      const Velocity<S> back = Group::log(Group::compose(Group::inverse(last.q), point.q));
      u += (h * b) * (Group::tangent_inverse(back) * point.v);
      NoAudit audit;
      const auto dynamics = consistent_dynamics(system, point.t, point.q, point.v, audit);
      ASSERT_TRUE(dynamics.has_value());
      v += (h * b) * dynamics->acceleration;
      size += std::abs(to_double(b)) * to_double(T(point.v.norm() + h * dynamics->acceleration.norm()));
    }
    // Logarithms are known to 4 eps, and T^{-1} of them changes v by |v| / 2 times that.
    const double tolerance = 32 * unit * (1 + to_double(h) * size * 2);
    const Velocity<S> moved = Group::log(Group::compose(Group::inverse(last.q), stepper->configuration()));
    ASSERT_LE(to_double((moved - u).norm()), tolerance) << k << ", step " << step;
    ASSERT_LE(to_double((stepper->velocity() - v).norm()), tolerance + 8 * unit * size)
        << k << ", step " << step;
    points.push_back({stepper->time(), stepper->configuration(), stepper->velocity(), last.acceleration, {}});
  }
}

TEST(FaltinsenAdams, StepsAreTheClassicalMethodInCanonicalCoordinatesAboutTheLastPoint) {
  for (int k = 1; k <= most_adams_steps; ++k)
    for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(2)}) {
      expect_steps_satisfy_the_equations<HeavyTopSO3<double>>(k, p);
      expect_steps_satisfy_the_equations<ExtendedSO3>(k, p);
    }
}

TEST(FaltinsenAdams, HasOrderKOnRotations) {
  for (int k = 1; k <= most_adams_steps; ++k) {
    const Errors order = observed_orders<FaltinsenAdams, ExtendedSO3>({.k = k});
    EXPECT_NEAR(order.q, k, order_tolerance) << k;
    EXPECT_NEAR(order.v, k, order_tolerance) << k;
  }
}

// --- outcomes and options --------------------------------------------------------------------------------

TEST(FaltinsenAdams, StopsWhereTheStepsOfALogarithmTogetherTurnByPiOrMore) {
  // Two points have the step between them for a logarithm, and that is known.
  for (int k = 1; k <= most_adams_steps; ++k)
    expect_limit_of_spin<FaltinsenAdams>({.k = k}, std::numbers::pi / std::max(1, k - 1));
}

TEST(FaltinsenAdams, StopsAtTheStepFromWhichALogarithmIsBeyondPi) {
  for (int k = 3; k <= most_adams_steps; ++k)
    expect_stop_where_logarithms_span_pi<FaltinsenAdams>({.k = k}, k - 1, 0);
}

// What the start or the first step ends with; neither moves the state.
template <class S>
void expect_outcome(const S& system, Outcome expected) {
  for (int k = 1; k <= most_adams_steps; ++k) {
    const auto stepper = make_stepper<FaltinsenAdams, S>({.k = k}, system);
    std::vector<SolutionPoint<S>> points;
    for (int j = 0; j < k; ++j)
      points.push_back(
          {0.1 * j, system.initial_configuration(), system.initial_velocity(), Velocity<S>::Zero(), {}});
    Outcome outcome = stepper->start(0.1, points).outcome;
    if (outcome == Outcome::ok) outcome = stepper->step().outcome;
    EXPECT_EQ(name(outcome), name(expected)) << k;
    EXPECT_EQ(stepper->time(), points.back().t);
    EXPECT_EQ(stepper->configuration(), points.back().q);
    EXPECT_EQ(stepper->velocity(), points.back().v);
  }
}

TEST(FaltinsenAdams, SaysThatTheMassMatrixIsSingular) {
  expect_outcome(Particle<double, Unconstrained>(0.0), Outcome::singular_matrix);
}

TEST(FaltinsenAdams, SaysThatForcesAreNoNumbers) {
  expect_outcome(Particle<double, Unconstrained>(1.0, ParticleForce::no_number), Outcome::non_finite);
  expect_outcome(Particle<double, Unconstrained>(1.0, ParticleForce::infinite), Outcome::non_finite);
}

TEST(FaltinsenAdams, FitsSystemsWithoutConstraints) {
  EXPECT_TRUE((may_fit<FaltinsenAdams, HeavyTopSO3<double>>()));
  EXPECT_FALSE((may_fit<FaltinsenAdams, HeavyTopR3xSO3<double>>()));
}

TEST(FaltinsenAdams, OptionsSelectTheStepper) {
  const HeavyTopSO3<double> system{HeavyTopParameters{}};
  for (int k = 1; k <= most_adams_steps; ++k) {
    OptionValues values;
    values.set("k", k);
    const FaltinsenAdams::Options options = FaltinsenAdams::options(values);
    EXPECT_EQ(options.k, k);
    EXPECT_EQ(FaltinsenAdams::orders(values).v, k);
    const auto stepper = make_stepper<FaltinsenAdams, HeavyTopSO3<double>>(options, system);
    EXPECT_EQ(stepper->steps(), k);
    EXPECT_EQ(stepper->starting_points(), k);
  }
}

}  // namespace
}  // namespace liebench::faltinsen_adams_test
