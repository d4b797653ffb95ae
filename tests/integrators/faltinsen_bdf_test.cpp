#include "integrators/faltinsen_bdf.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "groups/extended.h"
#include "integrators/bliedf2nd.h"
#include "problems/heavy_top.h"
#include "tests/support/heavy_top_motion.h"
#include "tests/support/heavy_top_samples.h"
#include "tests/support/observed_order.h"
#include "tests/support/spinning_up.h"
#include "tests/support/step_law.h"
#include "tests/support/steppers.h"

namespace liebench::faltinsen_bdf_test {

namespace {

using Variant = FaltinsenBdf::Variant;
constexpr int most_steps = 4;
constexpr std::array variants{Variant::exact, Variant::bch};

template <class T>
double unit() {
  return to_double(Eigen::NumTraits<T>::epsilon());
}

template <MechanicalSystem S>
std::unique_ptr<AnyStepper<S>> make(const S& system, const FaltinsenBdf::Options& options) {
  return make_stepper<FaltinsenBdf, S>(options, system);
}

std::string text(const FaltinsenBdf::Options& options) {
  return "k = " + std::to_string(options.k) + (options.variant == Variant::exact ? ", exact" : ", bch") +
         (options.form == Form::index3 ? "" : ", stabilized") +
         (options.modified_start ? ", modified start" : "");
}

// --- what one step is ------------------------------------------------------------------------------------

// v_{n+1} = T(u) w, w = (1/h) sum alpha_i s_{n+1-i}, from the states alone. Exact: s_j = log(q_n^{-1} q_j). Truncated
// ("FMM-BCH"), with a = h Dq_{n-1}, b = h Dq_{n-2}, c = h Dq_{n-3}, u = h Dq_n:
//   s_{n-1} = -a,  s_{n-2} = -(a + b) + [a, b] / 2,  s_{n-3} = s - c - z / 2 - [s + c, z] / 12,  s = s_{n-2}, z = [s, c]
//   k <= 2: v = w;  k = 3: v = w - [u, w] / 2;  k = 4: v = w - [u, w] / 2 + [u, [u, w]] / 6
template <MechanicalSystem S>
class StepLaw : public BdfStepLaw<S> {
  using Base = BdfStepLaw<S>;

 public:
  using typename Base::Group;
  using typename Base::T;

  StepLaw(const S& system, const T& h, const FaltinsenBdf::Options& options)
      : Base(options.k, system, h), variant_(options.variant) {}

  // T(u) w - v_{n+1} with u = h (Dq_n + extra); in the stabilized form extra = B(q_n)^T eta.
  Velocity<S> kinematics(const Velocity<S>& extra) const {
    const int k = Base::k();
    Velocity<S> w = Velocity<S>::Constant(T(0.0));
    const Velocity<S> u = coordinates(0) + Base::h() * extra;
    w += Base::alpha(0) * u;
    for (int i = 2; i <= k; ++i) w += Base::alpha(i) * coordinates(i);
    w /= Base::h();
    if (variant_ == Variant::exact) return Group::tangent(u) * w - Base::v(0);
    Velocity<S> v = w;
    if (k >= 3) v -= bracket(u, w) / T(2.0);
    if (k >= 4) v += bracket(u, bracket(u, w)) / T(6.0);
    return v - Base::v(0);
  }

 private:
  static Velocity<S> bracket(const Velocity<S>& x, const Velocity<S>& y) { return Group::commutator(x, y); }

  // s_{n+1-i}
  Velocity<S> coordinates(int i) const {
    if (variant_ == Variant::exact || i == 0)
      return Group::log(Group::compose(Group::inverse(Base::q(1)), Base::q(i)));
    const Velocity<S> a = Base::h() * Base::increment(1);
    if (i == 2) return -a;
    const Velocity<S> b = Base::h() * Base::increment(2);
    const Velocity<S> s = bracket(a, b) / T(2.0) - a - b;
    if (i == 3) return s;
    const Velocity<S> c = Base::h() * Base::increment(3);
    const Velocity<S> z = bracket(s, c);
    return s - c - z / T(2.0) - bracket(s + c, z) / T(12.0);
  }

  Variant variant_;
};

template <class S>
void expect_steps_satisfy_the_equations(const HeavyTopParameters& p, const FaltinsenBdf::Options& options) {
  using T = typename S::Scalar;
  const S system(p);
  const T h(1.0 / 64);
  constexpr int steps = 40;
  const HeavyTopMotion motion(p, 0.8);
  const auto stepper = make(system, options);
  const int k = options.k;
  const auto points = exact_starting_points(system, motion, h, stepper->starting_points());
  ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
  StepLaw<S> law(system, h, options);
  // Eq. (56) moves every starting velocity by the same vector, which the last of them shows.
  const Velocity<S> moved = stepper->velocity() - points[std::size_t(k - 1)].v;
  for (int j = 0; j < k; ++j) law.push(points[std::size_t(j)].q, points[std::size_t(j)].v + moved);

  // As for BLieDF2nd: logarithms are known to eps, increments to eps / h, differences accumulate them over the steps.
  const double speed = 1 + to_double(stepper->velocity().norm());
  const double mass = to_double(VelocityMatrix<S>(system.mass_matrix(points[0].q)).norm());
  const double kinematic = 64 * steps * unit<T>() * (speed + 2 / to_double(h));
  const double dynamic = 64 * steps * unit<T>() * mass * (speed + 2 / to_double(h));
  for (int n = k; n < k + steps; ++n) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok) << text(options) << ", step " << n;
    law.push(stepper->configuration(), stepper->velocity());
    Velocity<S> defect = law.kinematics(Velocity<S>::Constant(T(0.0)));
    if constexpr (S::constraints > 0) {
      const auto& q = stepper->configuration();
      EXPECT_LE(to_double(system.constraint(q).norm()), 64 * unit<T>()) << text(options) << ", step " << n;
      if (options.form == Form::stabilized_index2) {
        // The velocity is known to what the increments are.
        const Multipliers<S> hidden = system.constraint_gradient(q) * stepper->velocity();
        EXPECT_LE(to_double(hidden.norm()), 64 * unit<T>() * (speed + 1 / to_double(h)))
            << text(options) << ", step " << n;
        // eta by fixed-point sweeps, each of which gains h |v| = 0.1 at least; six equations, three unknowns.
        Velocity<S> extra = Velocity<S>::Constant(T(0.0));
        for (int sweep = 0; sweep < 40; ++sweep) {
          extra -= (defect - law.without_auxiliary_multiplier(defect)) / law.gamma(1);
          defect = law.kinematics(extra);
        }
      }
    }
    EXPECT_LE(to_double(defect.norm()), kinematic) << text(options) << ", step " << n;
    EXPECT_LE(to_double(law.dynamics(stepper->time(), stepper->multipliers()).norm()), dynamic)
        << text(options) << ", step " << n;
  }
}

template <class S>
void expect_every_method_satisfies_its_equations() {
  for (const HeavyTopParameters& p : {slow_top(), unsymmetric_top(2)})
    for (const Variant variant : variants)
      for (int k = 1; k <= most_steps; ++k) {
        expect_steps_satisfy_the_equations<S>(p, {.k = k, .variant = variant});
        if constexpr (S::constraints > 0) {
          expect_steps_satisfy_the_equations<S>(p, {.k = k, .variant = variant, .modified_start = true});
          expect_steps_satisfy_the_equations<S>(
              p, {.k = k, .variant = variant, .form = Form::stabilized_index2});
        }
      }
}

TEST(FaltinsenBdf, StepsAreTheClassicalMethodInCanonicalCoordinatesAboutTheLastPoint) {
  expect_every_method_satisfies_its_equations<HeavyTopSO3<double>>();
  expect_every_method_satisfies_its_equations<ExtendedSO3>();
}

TEST(FaltinsenBdf, ConstrainedStepsAreTheClassicalMethodInCanonicalCoordinatesAboutTheLastPoint) {
  expect_every_method_satisfies_its_equations<HeavyTopR3xSO3<double>>();
  expect_every_method_satisfies_its_equations<ExtendedR3xSO3>();
}

// Eq. (56) with the local error of this method: B Dv = B l / h, M Dv in the range of B^T.
TEST(FaltinsenBdf, ModifiedStartTakesTheLocalErrorOfTheMethodFromTheSolution) {
  using S = ExtendedR3xSO3;
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const Extended h(1.0 / 64);
  const HeavyTopMotion motion(p, 0.2);
  for (const Variant variant : variants)
    for (int k = 1; k <= most_steps; ++k) {
      const FaltinsenBdf::Options options{.k = k, .variant = variant, .modified_start = true};
      const auto stepper = make(system, options);
      const auto points = exact_starting_points(system, motion, h, k + 1);
      ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
      const Velocity<S> moved = stepper->velocity() - points[std::size_t(k - 1)].v;
      StepLaw<S> law(system, h, options);
      for (const SolutionPoint<S>& point : points) law.push(point.q, point.v);
      const Velocity<S> local_error = law.kinematics(Velocity<S>::Constant(Extended(0.0)));
      const auto& q = points[std::size_t(k - 1)].q;
      const auto B = system.constraint_gradient(q);
      const double scale = unit<Extended>() * 1e4 / to_double(h);
      EXPECT_LE(to_double((B * (moved - local_error)).norm()), scale) << text(options);
      EXPECT_LE(std::abs(to_double(Extended(system.momentum(q, moved).dot(points[std::size_t(k - 1)].v)))),
                100 * scale)
          << text(options);
      EXPECT_GT(to_double(moved.norm()), 1e-12) << text(options);
    }
}

// --- orders ----------------------------------------------------------------------------------------------

template <class S>
Errors orders(const FaltinsenBdf::Options& options) {
  return observed_orders<FaltinsenBdf, S>(options);
}

TEST(FaltinsenBdf, HasOrderKInConfigurationAndVelocity) {
  for (const Variant variant : variants)
    for (int k = 1; k <= most_steps; ++k) {
      const Errors order = orders<ExtendedSO3>({.k = k, .variant = variant});
      EXPECT_NEAR(order.q, k, order_tolerance) << k;
      EXPECT_NEAR(order.v, k, order_tolerance) << k;
    }
}

TEST(FaltinsenBdf, HasOrderKWithConstraintsButForLambdaInTheTransientPhase) {
  for (const Variant variant : variants)
    for (int k = 1; k <= most_steps; ++k) {
      const Errors order = orders<ExtendedR3xSO3>({.k = k, .variant = variant});
      EXPECT_NEAR(order.q, k, order_tolerance) << k;
      EXPECT_NEAR(order.v, k, order_tolerance) << k;
      EXPECT_NEAR(order.lambda, k, order_tolerance) << k;
      EXPECT_NEAR(order.largest_lambda, k - 1, order_tolerance) << k;
    }
}

TEST(FaltinsenBdf, KeepsTheOrderOfLambdaFromModifiedStartingVelocities) {
  for (const Variant variant : variants)
    for (int k = 2; k <= most_steps; ++k) {
      const Errors order = orders<ExtendedR3xSO3>({.k = k, .variant = variant, .modified_start = true});
      EXPECT_NEAR(order.q, k, order_tolerance) << k;
      EXPECT_NEAR(order.v, k, order_tolerance) << k;
      EXPECT_NEAR(order.lambda, k, order_tolerance) << k;
      EXPECT_NEAR(order.largest_lambda, k, order_tolerance) << k;
    }
}

TEST(FaltinsenBdf, HasOrderKInAllComponentsFromTheFirstStepInTheStabilizedForm) {
  for (const Variant variant : variants)
    for (int k = 2; k <= most_steps; ++k) {
      const Errors order =
          orders<ExtendedR3xSO3>({.k = k, .variant = variant, .form = Form::stabilized_index2});
      EXPECT_NEAR(order.q, k, order_tolerance) << k;
      EXPECT_NEAR(order.v, k, order_tolerance) << k;
      EXPECT_NEAR(order.lambda, k, order_tolerance) << k;
      EXPECT_NEAR(order.largest_lambda, k, order_tolerance) << k;
    }
}

// --- BLieDF2nd and others --------------------------------------------------------------------------------

template <class S>
void expect_bits_of_bliedf2nd(const FaltinsenBdf::Options& options) {
  const HeavyTopParameters p = unsymmetric_top(1);
  const S system(p);
  const HeavyTopMotion motion(p, 0.2);
  const auto stepper = make(system, options);
  const auto other = make_stepper<BLieDF2nd, S>(
      {.k = options.k, .modified_start = options.modified_start, .form = options.form}, system);
  const auto points = exact_starting_points(system, motion, 0.01, options.k + 1);
  ASSERT_EQ(stepper->start(0.01, points).outcome, Outcome::ok);
  ASSERT_EQ(other->start(0.01, points).outcome, Outcome::ok);
  for (int n = 0; n < 50; ++n) {
    ASSERT_EQ(stepper->step().outcome, Outcome::ok);
    ASSERT_EQ(other->step().outcome, Outcome::ok);
    EXPECT_EQ(S::Group::stacked(stepper->configuration()), S::Group::stacked(other->configuration()));
    EXPECT_EQ(stepper->velocity(), other->velocity());
    EXPECT_EQ(stepper->multipliers(), other->multipliers());
  }
}

TEST(FaltinsenBdf, IsBLieDF2ndWhereNoCommutatorEnters) {
  for (const FaltinsenBdf::Options& options :
       {FaltinsenBdf::Options{.k = 1, .variant = Variant::exact},
        FaltinsenBdf::Options{.k = 1, .variant = Variant::bch},
        FaltinsenBdf::Options{.k = 2, .variant = Variant::bch},
        FaltinsenBdf::Options{.k = 2, .variant = Variant::bch, .modified_start = true},
        FaltinsenBdf::Options{.k = 2, .variant = Variant::bch, .form = Form::stabilized_index2}}) {
    if (!options.modified_start && options.form == Form::index3)
      expect_bits_of_bliedf2nd<HeavyTopSO3<double>>(options);
    expect_bits_of_bliedf2nd<HeavyTopR3xSO3<double>>(options);
  }
}

TEST(FaltinsenBdf, VariantsDifferByOneOrderMoreThanTheirOwn) {
  // What the series leave out is of the size of the local error: the two solutions are next to each other in order k.
  const HeavyTopParameters p = slow_top();
  const ExtendedSO3 system(p);
  const HeavyTopMotion motion(p, 0.6);
  for (int k = 2; k <= most_steps; ++k) {
    std::vector<double> distance;
    for (const int steps : {256, 512}) {
      const Extended h = Extended(0.5) / double(steps);
      std::vector<std::unique_ptr<AnyStepper<ExtendedSO3>>> pair;
      for (const Variant variant : variants) {
        pair.push_back(make(system, {.k = k, .variant = variant}));
        ASSERT_EQ(pair.back()->start(h, exact_starting_points(system, motion, h, k + 1)).outcome,
                  Outcome::ok);
        for (int n = k; n <= steps; ++n) ASSERT_EQ(pair.back()->step().outcome, Outcome::ok);
      }
      distance.push_back(
          ExtendedSO3::Group::separation(pair[0]->configuration(), pair[1]->configuration()).norm());
    }
    EXPECT_GT(std::log2(distance[0] / distance[1]), k - 0.2) << k;
    EXPECT_GT(distance[1], 0.0) << k;
  }
}

// --- outcomes --------------------------------------------------------------------------------------------

// A body that spins freely by `turn` in a step.
Outcome spin(int k, Variant variant, double turn, int steps) {
  HeavyTopParameters p;
  p.gravity = {0, 0, 0};
  p.angular_velocity = {0, 8, 0};
  using S = HeavyTopSO3<double>;
  const S system(p);
  const double h = turn / 8;
  std::vector<SolutionPoint<S>> points;
  for (int j = 0; j <= k; ++j)
    points.push_back({j * h,
                      SO3<double>::exp(j * h * system.initial_velocity()),
                      system.initial_velocity(),
                      Eigen::Vector3d::Zero(),
                      {}});
  const auto stepper = make(system, {.k = k, .variant = variant});
  Outcome outcome = stepper->start(h, points).outcome;
  for (int n = 0; n < steps && outcome == Outcome::ok; ++n) {
    outcome = stepper->step().outcome;
    if (outcome != Outcome::ok) break;
    // The right branch: a wrong one is off by 2 pi / h.
    EXPECT_LE((stepper->velocity() - system.initial_velocity()).norm(), 1e-12) << k << ' ' << turn;
  }
  return outcome;
}

TEST(FaltinsenBdf, StopsWhereTheStepsOfALogarithmTogetherTurnByPiOrMore) {
  // The exact variant takes logarithms over k - 1 steps.
  for (int k = 3; k <= most_steps; ++k) {
    const double limit = std::numbers::pi / (k - 1);
    EXPECT_EQ(spin(k, Variant::exact, 0.99 * limit, 8), Outcome::ok) << k;
    EXPECT_EQ(spin(k, Variant::exact, 1.01 * limit, 8), Outcome::rotation_too_large) << k;
  }
}

TEST(FaltinsenBdf, StopsOtherwiseWhereAStepTurnsByPiOrMore) {
  const auto check = [](int k, Variant variant) {
    EXPECT_EQ(spin(k, variant, 0.99 * std::numbers::pi, 8), Outcome::ok) << k;
    EXPECT_EQ(spin(k, variant, 1.01 * std::numbers::pi, 8), Outcome::rotation_too_large) << k;
  };
  for (int k = 1; k <= 2; ++k) check(k, Variant::exact);
  for (int k = 1; k <= most_steps; ++k) check(k, Variant::bch);
}

TEST(FaltinsenBdf, StopsAtTheStepFromWhichALogarithmIsBeyondPi) {
  // omega = omega_0 + a t about one axis, where every increment is the mean of omega over its step up to O(h^2) = 0.01.
  using S = SpinningUp<double>;
  const S system;
  const double h = 0.25, increase = S::acceleration * h;
  for (int k = 3; k <= most_steps; ++k) {
    std::vector<SolutionPoint<S>> points;
    for (int j = 0; j <= k; ++j) points.push_back(spinning_up_point(j * h));
    const auto stepper = make(system, {.k = k, .variant = Variant::exact});
    ASSERT_EQ(stepper->start(h, points).outcome, Outcome::ok);
    int n = k - 1;  // the steps so far
    Outcome outcome = Outcome::ok;
    for (; n < 200; ++n) {
      outcome = stepper->step().outcome;
      if (outcome != Outcome::ok) break;
      EXPECT_LE((stepper->velocity() - spinning_up_point((n + 1) * h).v).norm(), 1e-11) << n;
    }
    EXPECT_EQ(outcome, Outcome::rotation_too_large);
    // From t_n: omega over the k - 1 steps before it.
    const double omega = spinning_up_point(n * h).v.norm() - 0.5 * (k - 1) * increase;
    EXPECT_NEAR((k - 1) * h * omega, std::numbers::pi, 2 * (k - 1) * h * increase) << k;
    EXPECT_EQ(stepper->time(), n * h);
  }
}

TEST(FaltinsenBdf, OptionsSelectTheStepper) {
  const HeavyTopSO3<double> system{HeavyTopParameters{}};
  for (int k = 1; k <= most_steps; ++k)
    for (const std::string word : {"exact", "bch"}) {
      OptionValues values;
      values.set("k", k);
      values.set("variant", word);
      const FaltinsenBdf::Options options = FaltinsenBdf::options(values);
      EXPECT_EQ(options.k, k);
      EXPECT_EQ(options.variant, word == "bch" ? Variant::bch : Variant::exact);
      EXPECT_FALSE(options.modified_start);
      EXPECT_EQ(options.form, Form::index3);
      EXPECT_EQ(make(system, options)->steps(), k);
    }
}

}  // namespace
}  // namespace liebench::faltinsen_bdf_test
