#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "integrators/affine_closure.h"
#include "integrators/newton.h"
#include "tests/support/method_cases.h"
#include "tests/support/small_systems.h"
#include "tests/support/spinning_up.h"
#include "tests/support/step_law.h"
#include "tests/support/steppers.h"

// Laws of every integrator in every combination of its options on small systems. Those on formulations of the heavy top:
// tests/support/listed_methods.h.

namespace liebench::method_laws_test {
namespace {

// q_0 + j h v_0, whatever the forces.
template <class S>
std::vector<SolutionPoint<S>> straight_points(const S& system, double h) {
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < 8; ++j)
    points.push_back({j * h, system.initial_configuration() + j * h * system.initial_velocity(),
                      system.initial_velocity(), Velocity<S>::Zero(), Multipliers<S>::Zero()});
  return points;
}

// What the first step, or the start before it, ends with.
template <class S>
void expect_outcome(const S& system, Outcome expected, std::string_view but_of = "") {
  constexpr double h = 0.1;
  const auto points = straight_points(system, h);
  const auto methods = every_method_of_fixed_steps<S>();
  for (const MethodCase<S>& method : methods) {
    if (method.method == but_of) continue;
    const auto stepper = method.stepper(system);
    Outcome outcome =
        stepper->start(h, std::span(points).first(std::size_t(stepper->starting_points()))).outcome;
    if (outcome == Outcome::ok) {
      outcome = stepper->step().outcome;
      EXPECT_EQ(stepper->time(), (stepper->steps() - 1) * h) << method.text();  // the step was not taken
    }
    EXPECT_EQ(name(outcome), name(expected)) << method.text();
  }
}

TEST(EveryMethod, ReportsARedundantConstraintAsSingular) {
  for (const double mass : {1.0, 3.0, 7.0})
    expect_outcome(Particle<double, RedundantConstraint>(mass), Outcome::singular_matrix);
}

TEST(EveryMethod, ReportsForcesThatAreNoNumbersAsNonFinite) {
  expect_outcome(Particle<double, Unconstrained>(1.0, ParticleForce::no_number), Outcome::non_finite);
  expect_outcome(Particle<double, Unconstrained>(1.0, ParticleForce::infinite), Outcome::non_finite);
}

TEST(EveryMethod, ReportsAConstraintWithoutSolutionAsDivergence) {
  // Half-explicit methods do not solve Phi = 0.
  expect_outcome(Particle<double, ImpossibleConstraint>(), Outcome::newton_diverged, HalfExplicit::name);
}

TEST(EveryMethod, FollowsARotationThatGrowsFasterUntilAStepTurnsByPi) {
  // Omega = 2 + t / 2 about one axis: all methods are exact in v. Those that take logarithms over several steps stop before
  // a step turns by pi; none goes on along another branch, which would be off by 2 pi / h.
  using S = SpinningUp<double>;
  const S system;
  constexpr double h = 0.2;
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < 8; ++j) points.push_back(spinning_up_point(j * h));
  for (const MethodCase<S>& method : every_method_of_fixed_steps<S>()) {
    const auto stepper = method.stepper(system);
    ASSERT_EQ(stepper->start(h, std::span(points).first(std::size_t(stepper->starting_points()))).outcome,
              Outcome::ok);
    Outcome outcome = Outcome::ok;
    double omega = 0.0;
    for (int n = stepper->steps(); n < 200; ++n) {
      outcome = stepper->step().outcome;
      if (outcome != Outcome::ok) break;
      const auto exact = spinning_up_point(n * h).v;
      omega = exact(2);
      // v' is known to eps |v| / h, and 100 steps add up.
      ASSERT_LE((stepper->velocity() - exact).norm(), 1e-11) << method.text() << ", step " << n;
    }
    EXPECT_EQ(name(outcome), name(Outcome::rotation_too_large)) << method.text();
    EXPECT_LE(h * omega, std::numbers::pi + h * h) << method.text();
    // So many steps at most in a logarithm.
    const bool all = method.method == CentredBdf::name || method.method == FaltinsenAdams::name;
    const int spanned = all ? stepper->steps() : 3;
    EXPECT_GE(h * omega * spanned, std::numbers::pi - spanned * h * h) << method.text();
  }
}

// --- linear spaces ---------------------------------------------------------------------------------------

// The classical BDF method for M q'' = -g in increments, from the textbook: q_{n+1} = q_n + h x_n,
//   sum gamma_i x_{n+1-i} = v_{n+1},   h v'_{n+1} = sum alpha_i v_{n+1-i} = sum gamma_i (v_{n+2-i} - v_{n+1-i})
// with both sums in differences, and the Newton iteration of the program. No group, no stepper, no history.
template <int n>
class TextbookBdf {
 public:
  using S = Oscillators<double, n>;
  using Vector = Eigen::Matrix<double, n, 1>;

  TextbookBdf(int k, const S& system, double step_size, const std::vector<SolutionPoint<S>>& points)
      : k_(k), h_(step_size), newton_(system) {
    const BdfStepLaw<S> coefficients(k, system, step_size);
    for (int i = 1; i <= k; ++i) gamma_.push_back(coefficients.gamma(i));
    const auto& last = points[std::size_t(k - 1)];
    t_ = last.t;
    q_ = last.q;
    v_ = last.v;
    x_ = points[0].v;
    Vector sum = Vector::Zero();
    for (std::size_t j = 1; j < std::size_t(k); ++j) {
      const Vector x = (points[j].q - points[j - 1].q) / h_;
      if (j > 1) x_changes_.insert(x_changes_.begin(), x - x_);
      v_changes_.insert(v_changes_.begin(), points[j].v - points[j - 1].v);
      x_ = x;
      sum += gamma_[std::size_t(k) - j] * x;
    }
    first_change_ = gamma_[0] * x_ + sum - v_;
  }

  const Vector& configuration() const { return q_; }
  const Vector& velocity() const { return v_; }

  Outcome step() {
    // v_{n+1} - v_n and h v'_{n+1} for x_n = x_{n-1}
    Vector change = first_change_;
    if (!first_) {
      change = Vector::Zero();
      for (std::size_t i = 1; i < std::size_t(k_); ++i) change += gamma_[i] * x_changes_[i - 1];
    }
    Vector acceleration = gamma_[0] * change;
    for (std::size_t i = 1; i < std::size_t(k_); ++i) acceleration += gamma_[i] * v_changes_[i - 1];
    const AffineClosure<S> closure{.base_increment = x_,
                                   .velocity = v_,
                                   .velocity_slope = gamma_[0],
                                   .velocity_change = change,
                                   .acceleration_slope = gamma_[0] * gamma_[0],
                                   .scaled_acceleration = acceleration};
    Vector d = Vector::Zero();
    if (!v_changes_.empty()) d = (extrapolated() - change) / gamma_[0];
    typename Kernel::Point point;
    const Outcome outcome = newton_.solve(t_ + h_, h_, q_, closure, d, point).outcome;
    const Vector x = x_ + d;
    const Vector v_change = gamma_[0] * d + change;
    t_ += h_;
    q_ += h_ * x;
    v_ += v_change;
    x_ = x;
    keep(x_changes_, d);
    keep(v_changes_, v_change);
    first_ = false;
    return outcome;
  }

 private:
  using Kernel = NewtonKernel<S, Form::index3, NoAudit>;

  // k + 1 values, newest first.
  void keep(std::vector<Vector>& values, const Vector& newest) const {
    values.insert(values.begin(), newest);
    if (values.size() > std::size_t(k_) + 1) values.pop_back();
  }
  // By the polynomial through all values: s x_n - binomial(s, 2) x_{n-1} + ...
  Vector extrapolated() const {
    const double s = double(v_changes_.size());
    double coefficient = s;
    Vector sum = Vector::Zero();
    for (std::size_t i = 0; i < v_changes_.size(); ++i) {
      sum += coefficient * v_changes_[i];
      coefficient *= -(s - double(i) - 1) / (double(i) + 2);
    }
    return sum;
  }

  int k_;
  double h_, t_ = 0;
  std::vector<double> gamma_;
  Kernel newton_;
  Vector q_, v_, x_, first_change_;
  std::vector<Vector> x_changes_, v_changes_;
  bool first_ = true;
};

TEST(EveryBdfMethod, IsTheClassicalOneBitForBitOnALinearSpace) {
  // BLieDF2nd with any correction, that of Faltinsen et al. in both variants, and the centred one: nothing of the group is left.
  constexpr int n = 3;
  using S = Oscillators<double, n>;
  const S system;
  constexpr double h = 1.0 / 32;
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j < 8; ++j)
    points.push_back({j * h,
                      system.initial_configuration() + system.initial_velocity() * std::sin(j * h),
                      system.initial_velocity() * std::cos(j * h),
                      S::Vector::Zero(),
                      {}});
  int compared = 0;
  for (const MethodCase<S>& method : every_method_of_fixed_steps<S>()) {
    if (method.method != BLieDF2nd::name && method.method != FaltinsenBdf::name &&
        method.method != CentredBdf::name)
      continue;
    const int k = method.options.integer("k");
    const auto stepper = method.stepper(system);
    ASSERT_EQ(stepper->start(h, std::span(points).first(std::size_t(k + 1))).outcome, Outcome::ok);
    TextbookBdf<n> textbook(k, system, h, points);
    for (int step = 1; step <= 64; ++step) {
      ASSERT_EQ(stepper->step().outcome, Outcome::ok);
      ASSERT_EQ(textbook.step(), Outcome::ok);
      ASSERT_EQ(stepper->configuration(), textbook.configuration()) << method.text() << ", step " << step;
      ASSERT_EQ(stepper->velocity(), textbook.velocity()) << method.text() << ", step " << step;
    }
    ++compared;
  }
  EXPECT_GE(compared, 6 * 3 + 4 * 2 + 6);
}

// --- options ---------------------------------------------------------------------------------------------

template <class Method>
void expect_options_in_order() {
  for (const OptionInfo& option : Method::option_list) {
    EXPECT_FALSE(option.meaning.empty()) << Method::name << ' ' << option.name;
    const bool numeric = option.kind == OptionKind::integer || option.kind == OptionKind::real;
    EXPECT_EQ(numeric, option.least < option.most) << Method::name << ' ' << option.name;
    if (numeric) {
      EXPECT_LE(option.least, option.fallback) << Method::name << ' ' << option.name;
      EXPECT_LE(option.fallback, option.most) << Method::name << ' ' << option.name;
    }
    const bool words = option.kind == OptionKind::choice || option.kind == OptionKind::boolean_or_choice;
    EXPECT_EQ(words, !option.choices[0].empty()) << Method::name << ' ' << option.name;
  }
  EXPECT_FALSE(Method::name.empty());
  EXPECT_FALSE(Method::summary.empty());
}

TEST(EveryMethod, DescribesItsOptions) {
  []<class... Methods>(IntegratorList<Methods...>) {
    (expect_options_in_order<Methods>(), ...);
  }(Integrators{});
}

}  // namespace
}  // namespace liebench::method_laws_test
