#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/math/differentiation/autodiff.hpp>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "integrators/bliedf2nd.h"
#include "integrators/faltinsen_bdf.h"
#include "integrators/generalized_alpha.h"
#include "problems/scene_examples.h"
#include "tests/harness/scene_runs.h"

// Scenes with loops and joints against the same mechanisms in generalized coordinates, as many as they have degrees of freedom: no
// constraint, no rotation matrix, no group, no code of scenes. The equations are Lagrange's, derived here by hand from the
// published data and integrated in long double.

namespace liebench {
namespace {

using Real = long double;

// y(t_end) of y' = f(y), by Runge-Kutta-Fehlberg 7(8) with a local error of 1e-15 a step: over 10^5 steps 1e-10 at most, and
// less than 1e-12 where steps are few or errors decay.
template <std::size_t n, class F>
std::array<Real, n> integrated(std::array<Real, n> y, Real t_end, const F& f) {
  using State = std::array<Real, n>;
  namespace ode = boost::numeric::odeint;
  const auto stepper =
      ode::make_controlled<ode::runge_kutta_fehlberg78<State, Real>>(Real(1e-15), Real(1e-15));
  ode::integrate_adaptive(
      stepper, [&](const State& state, State& rate, Real) { rate = f(state); }, y, Real(0.0), t_end,
      Real(1e-6));
  return y;
}

using Result = std::vector<double>;

struct MethodOfOrder {
  MethodOptions options;
  int order;
};

// Errors of the scene's results with the steps h and h / 2 fall with the order of the method and come from it alone: the difference of
// the two results says how large the finer one's error is, e = d / (2^p - 1). The quotient of the errors is 2^p only where h goes to
// 0 (of BDF with even k the next term is felt for long): orders up to p + 1 are allowed, and with them three times e.
void expect_convergence(const std::function<Result(const MethodOptions&, double)>& end,
                        const std::vector<Real>& exact, double h, const std::vector<MethodOfOrder>& methods) {
  for (const MethodOfOrder& method : methods) {
    const Result coarse = end(method.options, h), fine = end(method.options, h / 2.0);
    const double quotient = std::pow(2.0, method.order);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const double coarse_error = std::abs(double(coarse[i] - exact[i]));
      const double fine_error = std::abs(double(fine[i] - exact[i]));
      const double order = std::log2(coarse_error / fine_error);
      EXPECT_GE(order, method.order - 0.3) << method.order << ", " << i;
      EXPECT_LE(order, method.order + 1.0) << method.order << ", " << i;
      EXPECT_LE(fine_error, 3.0 * std::abs(coarse[i] - fine[i]) / (quotient - 1.0))
          << method.order << ", " << i;
    }
  }
}

// --- spatial slider-crank -------------------------------------------------------------------------------------

// Masoudi & McPhee (IFToMM library). theta: angle of the crank about the x axis through C, from upright. The crank pin is
// A = C + r (0, -sin theta, cos theta), the slider is at (s, 0, 0) with |A - (s, 0, 0)| = L, the conrod goes along the unit vector
// d from A to the slider. Its cross pin m, of the universal joint, is across d and across the x axis, along which the other axis of
// the joint lies, for the slider does not turn: m = e_x x d / |e_x x d|. So the frame (d, m, d x m) of the conrod follows from d. It
// turns about d by d_x chi', chi the angle of d about the x axis, and across d by |d'|; the conrod's inertia is the same about all
// axes across d. Every velocity is theta' times a function of theta, hence T = M(theta) theta'^2 / 2 and Lagrange's equation
//
//   M theta'' + M' theta'^2 / 2 + V' = 0
class SliderCrank {
 public:
  struct State {
    Real theta, rate;
  };
  // The centre of mass of the crank is so far from C.
  explicit SliderCrank(Real crank_arm) : crank_arm_(crank_arm) {}

  State at(Real t) const {
    const auto y = integrated<2>({0.0L, 6.0L}, t, [this](const std::array<Real, 2>& state) {
      return std::array<Real, 2>{state[1], acceleration(state[0], state[1])};
    });
    return {y[0], y[1]};
  }
  // Crank pin, slider and its velocity; the velocity of the conrod about itself.
  struct Pose {
    Real pin_y, pin_z, slider, slider_rate, spin;
  };
  static Pose pose(const State& state) {
    const Geometry g = geometry(state.theta);
    return {g.pin_y[0], g.pin_z[0], g.s[0], g.s[1] * state.rate, spin(g)[0] * state.rate};
  }
  Real energy(const State& state) const {
    const Inertia M = inertia(geometry(state.theta));
    return M.value * state.rate * state.rate / 2.0L + M.potential;
  }

 private:
  static constexpr Real r = 0.08L, L = 0.3L, y_C = 0.1L, z_C = 0.12L, gravity = 9.81L;
  static constexpr Real mass_crank = 0.12L, mass_rod = 0.5L, mass_slider = 2.0L;
  static constexpr Real J_crank = 1e-4L, J_along = 4e-4L, J_across = 4e-3L;

  using Derivatives = std::array<Real, 3>;  // a function of theta, its first and its second derivative
  struct Geometry {
    Derivatives pin_y, pin_z, s, chi;
    std::array<Derivatives, 3> d;
  };
  static Geometry geometry(Real at) {
    using boost::math::differentiation::make_fvar;
    const auto theta = make_fvar<Real, 2>(at);
    const auto derivatives = [](const auto& f) {
      return Derivatives{f.derivative(0), f.derivative(1), f.derivative(2)};
    };
    const auto y = y_C - r * sin(theta), z = z_C + r * cos(theta);
    const auto s = sqrt(L * L - y * y - z * z);
    const auto d_x = s / L, d_y = -y / L, d_z = -z / L;
    return {derivatives(y),
            derivatives(z),
            derivatives(s),
            derivatives(atan2(d_z, d_y)),
            {derivatives(d_x), derivatives(d_y), derivatives(d_z)}};
  }
  // d_x chi' / theta', and its derivative.
  static std::array<Real, 2> spin(const Geometry& g) {
    return {g.d[0][0] * g.chi[1], g.d[0][1] * g.chi[1] + g.d[0][0] * g.chi[2]};
  }
  struct Inertia {
    Real value, slope, potential, potential_slope;
  };
  Inertia inertia(const Geometry& g) const {
    Inertia M{J_crank + mass_crank * crank_arm_ * crank_arm_, 0.0L, 0.0L, 0.0L};
    const auto add = [&](Real mass, Real rate, Real change) {
      M.value += mass * rate * rate;
      M.slope += 2.0L * mass * rate * change;
    };
    // The centre of mass of the conrod is in the middle.
    for (const Derivatives* x : {&g.pin_y, &g.pin_z, &g.s}) add(mass_rod / 4.0L, (*x)[1], (*x)[2]);
    for (const Derivatives& component : g.d) add(J_across, component[1], component[2]);
    const auto [turn, turn_change] = spin(g);
    add(J_along, turn, turn_change);
    add(mass_slider, g.s[1], g.s[2]);
    // The centre of mass of the crank is above C by crank_arm cos theta, that of the conrod above 0 by half of the pin's height.
    const Real above = gravity * mass_crank * crank_arm_ / r, half = gravity * mass_rod / 2.0L;
    M.potential = above * (g.pin_z[0] - z_C) + half * g.pin_z[0];
    M.potential_slope = (above + half) * g.pin_z[1];
    return M;
  }
  Real acceleration(Real theta, Real rate) const {
    const Inertia M = inertia(geometry(theta));
    return -(M.slope * rate * rate / 2.0L + M.potential_slope) / M.value;
  }

  Real crank_arm_;
};

// The same mechanism with the centre of mass of the crank on its axis, with MBDyn after 5 s with steps of 1e-4 s: slider and centre of
// the conrod, as the test bench of another program (Vinkulum) quotes them in seven digits and reproduces them to 1e-5 m with
// steps of 5e-4 s. Two methods of second order: of MBDyn's error some 1e-5 / 25 m, with a factor of ten for its constant.
TEST(SliderCrank, InOneCoordinateKeepsItsEnergyAndIsWhereAnotherProgramHasIt) {
  const SliderCrank crank(0.0L);
  const SliderCrank::State end = crank.at(5.0L);
  EXPECT_NEAR(double(crank.energy(end) - crank.energy({0.0L, 6.0L})), 0.0, 1e-13);
  const SliderCrank::Pose pose = SliderCrank::pose(end);
  EXPECT_NEAR(double(pose.slider), 0.2546481, 4e-6);
  EXPECT_NEAR(double(pose.pin_y) / 2.0, 0.0142809, 4e-6);
  EXPECT_NEAR(double(pose.pin_z) / 2.0, 0.0780041, 4e-6);
}

TEST(SliderCrank, MovesAsInOneCoordinate) {
  const AssembledScene scene = assembled_scene("slider_crank");
  EXPECT_EQ(scene.redundant_joints, std::vector<std::string>());
  const double t_end = 1.0;  // some two turns of the crank
  const SliderCrank::Pose exact = SliderCrank::pose(SliderCrank(0.04L).at(t_end));
  // Pin, slider and its velocity, spin of the conrod.
  const auto end = [&](const MethodOptions& method, double h) {
    const Sample sample = end_of_motion(scene, method, h, t_end);
    const BodySample &crank = sample.bodies[0], &conrod = sample.bodies[1], &slider = sample.bodies[2];
    const Eigen::Vector3d along = rotation_of(conrod).transpose() *
                                  (vector_of(slider.position) - vector_of(conrod.position)).normalized();
    return Result{2.0 * crank.position[1] - 0.1, 2.0 * crank.position[2] - 0.12, slider.position[0],
                  slider.velocity[0], along.dot(vector_of(conrod.angular_velocity))};
  };
  expect_convergence(end, {exact.pin_y, exact.pin_z, exact.slider, exact.slider_rate, exact.spin}, 0x1p-11,
                     {{BLieDF2nd::Options{.k = 2}, 2},
                      {BLieDF2nd::Options{.k = 3}, 3},
                      {BLieDF2nd::Options{.k = 4}, 4},
                      {GeneralizedAlpha::Options{}, 2},
                      {FaltinsenBdf::Options{.k = 3}, 3}});
}

// --- windows -----------------------------------------------------------------------------------------------------

// See four_bar(). 201 bodies and 1505 constraints, of which 300 are redundant; up to three quarters of the way to the flat place.
TEST(Windows, AHundredOfThemAreTheirPendulum) {
  const int n = 100;
  const AssembledScene scene = assemble(four_bar(n), "four_bar");
  const double t_end = 0.5;
  const Real w2 = 9.81L * ((n + 1) / 2.0L + n) / ((n + 1) / 3.0L + n);
  const auto exact = integrated<2>({0.0L, 1.0L}, t_end, [&](const std::array<Real, 2>& y) {
    return std::array<Real, 2>{y[1], w2 * std::sin(y[0])};
  });
  const auto end = [&](const MethodOptions& method, double h) {
    const Sample sample = end_of_motion(scene, method, h, t_end);
    const BodySample &first = sample.bodies.front(), &last = sample.bodies.back();
    return Result{std::atan2(first.position[0], first.position[1]), -first.angular_velocity[2],
                  std::atan2(last.position[0] - n, last.position[1]), -last.angular_velocity[2]};
  };
  expect_convergence(end, {exact[0], exact[1], exact[0], exact[1]}, 0x1p-6,
                     {{BLieDF2nd::Options{.k = 3}, 3}, {GeneralizedAlpha::Options{}, 2}});
}

// --- flyball governor --------------------------------------------------------------------------------------------

// IFToMM A05. psi: angle of the shaft about the vertical; z: height of the slider on it; beta: angle by which both arms hang below the
// level, the same one for the two, who begin alike. An arm is a rod of length 1 with a ball at its end, on a hinge at the height
// 1 and the distance r from the axis. What is at x on it moves on a circle of the radius r + x cos beta, so that
//
//   2 T = I(beta) psi'^2 + K beta'^2 + m_s z'^2,   I = I_0 + 2 sum of m (r + x cos beta)^2,   K = 2 sum of m x^2,
//
// sums over both parts of an arm, and with the terms of the width w of the rods. A spring of the tension F = k (l - l_0) + c l' goes
// from the slider, at the distance r from the axis, to the middle of each rod: l^2 = (cos(beta) / 2)^2 + (1 - sin(beta) / 2 - z)^2. psi is
// cyclic, its momentum p constant:
//
//   psi' = p / I,   K beta'' = I' psi'^2 / 2 + 2 g m x cos beta - 2 F dl/dbeta,   m_s z'' = -g m_s - 2 F dl/dz
class Governor {
 public:
  struct State {
    Real psi, psi_rate, z, z_rate, beta, beta_rate;
  };
  static State at(Real t) {
    const Real beta = std::numbers::pi_v<Real> / 6.0L;
    const Real momentum = 2.0L * std::numbers::pi_v<Real> * inertia(beta)[0];
    const auto y = integrated<5>({0.0L, 0.5L, 0.0L, beta, 0.0L}, t,
                                 [&](const std::array<Real, 5>& y) { return rates(y, momentum); });
    return {y[0], momentum / inertia(y[3])[0], y[1], y[2], y[3], y[4]};
  }

 private:
  static constexpr Real density = 3000.0L, r = 0.05L, w = 0.01L, side = 0.1L, gravity = 9.81L;
  static constexpr Real k = 8e5L, c = 4e4L, slack = 0.5L;
  static constexpr Real rod = density * w * w, ball = 5.0L, slider = density * side * side * side;

  // I and dI/dbeta. Of a rod of the square cross section w^2 the moment about its axis is m w^2 / 6, across it m (1 + w^2) / 12.
  static std::array<Real, 2> inertia(Real beta) {
    const Real C = std::cos(beta), S = std::sin(beta);
    const Real fixed = rod * w * w / 6.0L + slider * side * side / 6.0L;
    const Real value = ball * (r + C) * (r + C) + rod * (r + C / 2.0L) * (r + C / 2.0L) +
                       rod * (1.0L + w * w) / 12.0L * C * C + rod * w * w / 6.0L * S * S;
    const Real slope = -2.0L * ball * (r + C) * S - rod * (r + C / 2.0L) * S -
                       rod * (1.0L + w * w) / 6.0L * C * S + rod * w * w / 3.0L * S * C;
    return {fixed + 2.0L * value, 2.0L * slope};
  }
  static std::array<Real, 5> rates(const std::array<Real, 5>& y, Real momentum) {
    const auto [psi, z, z_rate, beta, beta_rate] = y;
    const Real C = std::cos(beta), S = std::sin(beta);
    const auto [I, I_slope] = inertia(beta);
    const Real psi_rate = momentum / I;
    const Real K = 2.0L * (ball + rod / 4.0L + rod * (1.0L + w * w) / 12.0L);
    const Real across = C / 2.0L, up = 1.0L - S / 2.0L - z, length = std::hypot(across, up);
    const Real by_beta = (-across * S - up * C) / (2.0L * length), by_z = -up / length;
    const Real F = k * (length - slack) + c * (by_beta * beta_rate + by_z * z_rate);
    // Beta grows downwards: the weight of an arm turns it so.
    const Real weight = 2.0L * gravity * (ball + rod / 2.0L) * C;
    return {psi_rate, z_rate, -gravity - 2.0L * F * by_z / slider, beta_rate,
            (I_slope * psi_rate * psi_rate / 2.0L + weight - 2.0L * F * by_beta) / K};
  }
};

// The springs' dampers let the slider follow at a rate of 2 c / m_s = 27,000 / s: the methods' own start, which is explicit, needs
// h below 3 / 27,000 s. With such steps errors of higher orders are near round-off and those of the first, fast motion.
TEST(Governor, MovesAsInThreeCoordinates) {
  const AssembledScene scene = assembled_scene("flyball_governor");
  const double t_end = 0.5;
  const Governor::State exact = Governor::at(t_end);
  const auto end = [&](const MethodOptions& method, double h) {
    const Sample sample = end_of_motion(scene, method, h, t_end);
    const BodySample &shaft = sample.bodies[0], &slider = sample.bodies[1], &arm = sample.bodies[2];
    const Eigen::Matrix3d R = rotation_of(shaft), A = rotation_of(arm);
    const Eigen::Vector3d omega = vector_of(arm.angular_velocity);
    return Result{std::atan2(R(1, 0), R(0, 0)), shaft.angular_velocity[2], slider.position[2],
                  slider.velocity[2],           std::asin(-A(2, 0)),       omega(1)};
  };
  const Real turns = std::round(exact.psi / (2.0L * std::numbers::pi_v<Real>));
  expect_convergence(end,
                     {exact.psi - 2.0L * std::numbers::pi_v<Real> * turns, exact.psi_rate, exact.z,
                      exact.z_rate, exact.beta, exact.beta_rate},
                     0x1p-14, {{BLieDF2nd::Options{.k = 2}, 2}, {GeneralizedAlpha::Options{}, 2}});
}

}  // namespace
}  // namespace liebench
