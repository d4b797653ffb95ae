#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "harness/references/heavy_top_wide.h"
#include "problems/heavy_top_parameters.h"

namespace liebench {

// The closed-form motion of the symmetric heavy top (Lagrange's), in Cayley-Klein parameters and Jacobi's
// theta functions, to some 35 digits or more.
//
// With e the upward vertical, a the body axis X / |X|, u = a . R^T e, A and C the transverse and the axial
// moments of inertia about the tip, b = C w / A, w = Omega . a, be = 2 m |gamma| |X| / A, p = (angular
// momentum about e) / A and h from the energy,
//
//   u'^2 = f(u) = be u^3 - (h + b^2) u^2 + (2 p b - be) u + h - p^2,      f(+-1) = -(p -+ b)^2,
//   u = (4 / be) P(z) + (h + b^2) / (3 be),     z = t + tau + w3,
//
// P Weierstrass' function with half-periods w1 (real) and w3 (imaginary). In frames whose third axes are e
// and a the quaternion of R is (Re alpha, Re beta, Im beta, Im alpha). With v = pi z / (2 w1) and
// L = theta_1' / theta_1,
//
//   alpha(t) = alpha_0 Q_a(t) / Q_a(0) exp(i r_a t),   r_a = (w - b) / 2 + i pi L(v_a) / (2 w1),
//   beta(t)  = beta_0  Q_c(t) / Q_c(0) exp(i r_c t),   r_c = (b - w) / 2 + i pi L(v_c) / (2 w1),
//   Q_a = theta_1(v + v_a) / theta_1(v),
//
// where u(a) = -1, u'(a) = -i (p + b); u(c) = 1, u'(c) = i (p - b). This is the design notes, section 8 with sigma
// and zeta written in theta functions, whereby the factors of eta_1 cancel, and with an initial state that
// need not be a turning point of u. Nothing is singular at u = +-1 (Klein & Sommerfeld, Theorie des
// Kreisels, ch. VI).
class HeavyTopClosedForm {
 public:
  // Empty unless it holds and keeps its digits for these data:
  //   - X and gravity do not vanish;
  //   - J_fix is A (I - a a^T) + C a a^T, to 1e-45 relative;
  //   - the axis does not start within 1e-5 of the vertical (alpha_0 or beta_0 would vanish);
  //   - the roots of f lie apart by 1e-6 of their spread (no steady precession, no asymptotic top).
  // Throws std::invalid_argument for bad parameters (see HeavyTopWideData).
  static std::optional<HeavyTopClosedForm> of(const HeavyTopParameters& parameters);

  // R and Omega at t [s], of either sign.
  HeavyTopWitness at(double t) const;

  // Period of the nutation u(t), 2 w1 [s].
  double nutation_period() const;

 private:
  struct Constants;
  explicit HeavyTopClosedForm(std::shared_ptr<const Constants> constants)
      : constants_(std::move(constants)) {}
  std::shared_ptr<const Constants> constants_;
};

}  // namespace liebench
