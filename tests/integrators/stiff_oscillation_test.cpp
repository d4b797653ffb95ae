#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "groups/real_space.h"
#include "integrators/bliedf2nd_variable.h"

// Methods of variable order on a stiff oscillation that is hardly damped: its poles are next to the imaginary axis, where BDF methods of
// order 3 and more are not stable.

namespace liebench::stiff_oscillation_test {
namespace {

constexpr double frequency = 1e3, ratio = 0.01;

// x'' + 2 ratio w x' + w^2 (x - f cos t) = 0 and y'' + y = 0.
template <Scalar T>
class PulledSpring {
 public:
  using Scalar = T;
  using Group = RealSpace<T, 2>;
  template <class U>
  using rebind = PulledSpring<U>;
  static constexpr int constraints = 0;
  static constexpr bool constant_mass = true;
  using Vector = Eigen::Matrix<T, 2, 1>;
  using Matrix = Eigen::Matrix<T, 2, 2>;
  using NoMultipliers = Eigen::Matrix<T, 0, 1>;

  explicit PulledSpring(double pull) : pull_(pull) {}
  template <class U>
  PulledSpring<U> cast() const {
    return PulledSpring<U>(pull_);
  }
  Matrix mass_matrix(const Vector&) const { return Matrix::Identity(); }
  Vector momentum(const Vector&, const Vector& w) const { return w; }
  Vector force(const T& t, const Vector& q, const Vector& v) const {
    using std::cos;
    return {T(frequency * frequency) * (q(0) - T(pull_) * cos(t)) + T(2.0 * ratio * frequency) * v(0), q(1)};
  }
  Matrix damping(const T&, const Vector&, const Vector&) const {
    return Vector(T(2.0 * ratio * frequency), T(0.0)).asDiagonal();
  }
  Matrix stiffness(const T&, const Vector&, const Vector&, const Vector&, const NoMultipliers&) const {
    return Vector(T(frequency * frequency), T(1.0)).asDiagonal();
  }
  T energy(const Vector&, const Vector&) const { return T(0.0); }
  T angular_momentum(const Vector&, const Vector&) const { return T(0.0); }
  Vector initial_configuration() const { return Vector(T(1.0), T(pull_)); }
  Vector initial_velocity() const { return Vector(T(0.0), T(0.0)); }

 private:
  double pull_;
};

struct Course {
  int steps = 0;
  double x = 0.0, y = 0.0;  // at the end
};

Course run(double pull, double tolerance, double end) {
  using S = PulledSpring<double>;
  const S system(pull);
  BLieDF2ndVariable::Stepper<S, Form::index3, NoAudit> stepper(system, {.tolerance = tolerance});
  SolutionPoint<S> first;
  first.t = 0.0;
  first.q = system.initial_configuration();
  first.v = system.initial_velocity();
  first.acceleration = -system.force(0.0, first.q, first.v);
  EXPECT_EQ(stepper.start(end, std::array{first}).outcome, Outcome::ok);
  Course course;
  while (!stepper.finished()) {
    if (stepper.step().outcome != Outcome::ok) {
      ADD_FAILURE() << "step " << course.steps;
      break;
    }
    ++course.steps;
  }
  course.x = stepper.configuration()(0);
  course.y = stepper.configuration()(1);
  return course;
}

TEST(BLieDF2ndVariable, LetsAStiffOscillationDieOutByTheOrderThatIsStable) {
  // Of k = 3 steps are bounded by (4 ratio)^{1/3} = 0.34 rad as long as it is kept up: 29,000 steps in 10 s, and CVODE 6.4.1 with
  // orders up to 4 takes 23,400, 30,800 and 50,100.
  constexpr double end = 10.0;
  const double bound = frequency * end / std::cbrt(4.0 * ratio);
  for (const auto& [tolerance, part] : {std::pair{1e-4, 0.25}, std::pair{1e-6, 0.5}}) {
    const Course course = run(0.0, tolerance, end);
    EXPECT_LE(course.steps, part * bound) << tolerance;
    // e^-100 of it, and what is kept up is some tolerances.
    EXPECT_LE(std::abs(course.x), 1e-3 * tolerance) << tolerance;
  }
}

TEST(BLieDF2ndVariable, FollowsASlowPullOnAStiffSpring) {
  // x = w^2 cos t / ((w^2 - 1) + ...) to 1 / w, y = cos t.
  for (const double tolerance : {1e-6, 1e-8}) {
    const Course course = run(1.0, tolerance, 10.0);
    const double permitted = tolerance * course.steps;
    EXPECT_NEAR(course.x, std::cos(10.0), 1e-4 + permitted) << tolerance;
    EXPECT_NEAR(course.y, std::cos(10.0), permitted) << tolerance;
  }
}

TEST(BLieDF2ndVariable, EndsAtOnceAfterAnIntervalOfNoLength) {
  using S = PulledSpring<double>;
  const S system(0.0);
  BLieDF2ndVariable::Stepper<S, Form::index3, NoAudit> stepper(system, {});
  SolutionPoint<S> first;
  first.t = 0.5;
  first.q = system.initial_configuration();
  first.v = system.initial_velocity();
  first.acceleration = -system.force(0.5, first.q, first.v);
  EXPECT_EQ(stepper.start(0.0, std::array{first}).outcome, Outcome::ok);
  EXPECT_TRUE(stepper.finished());
  EXPECT_EQ(stepper.time(), 0.5);
  EXPECT_EQ(stepper.configuration(), first.q);
  EXPECT_EQ(stepper.velocity(), first.v);
}

}  // namespace
}  // namespace liebench::stiff_oscillation_test
