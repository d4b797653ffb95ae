#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstddef>
#include <vector>

#include "groups/extended.h"
#include "integrators/starting_values.h"
#include "problems/heavy_top.h"

namespace liebench {

// The motion of a heavy top in extended precision for tests of integrators: Taylor series of
//
//   R' = R skew(Omega),   J Omega' = (J Omega) x Omega + X x R^T m gamma
//
// in the nine entries of R and in Omega, piece by piece. The equations are quadratic, so that the coefficients
// follow from convolutions: (j+1) R_{j+1} = sum_i R_i skew(Omega_{j-i}), and so on. No group operation and
// no formula of an integrator is used. Accuracy: pieces of width 1 / (8 + 4 |Omega(0)|) and degree 32 leave a
// truncation below 1e-30, so that the errors are the accumulated roundings; the tests of this class
// ask for 1e-28 (tests/problems/heavy_top_motion_test.cpp).
class HeavyTopMotion {
 public:
  using Vector = Eigen::Matrix<Extended, 3, 1>;
  using Matrix = Eigen::Matrix<Extended, 3, 3>;
  struct State {
    Matrix R;
    Vector omega, omega_dot;  // body frame
  };

  // From t = 0 up to `end` [s] at least; `refinement` shortens the pieces.
  HeavyTopMotion(const HeavyTopParameters& parameters, double end, double refinement = 1.0);

  State at(const Extended& t) const;

  // The same as a point of the solution of `system`, this top in any formulation and any scalar that is rounded from
  // Extended.
  template <MechanicalSystem S>
  SolutionPoint<S> point(const S& system, const Extended& t) const {
    if constexpr (std::same_as<typename S::Scalar, Extended>) {
      return point_of<S>(system, t);
    } else {
      return point_of<S>(typename S::template rebind<Extended>(parameters_), t);
    }
  }

  // Kinetic plus potential energy [J].
  Extended energy(const State& s) const;

 private:
  template <MechanicalSystem S, MechanicalSystem E>
  SolutionPoint<S> point_of(const E& system, const Extended& t) const {
    using T = typename S::Scalar;
    const State s = at(t);
    const auto rounded = [](const auto& v) { return v.template cast<T>().eval(); };
    SolutionPoint<S> p;
    if constexpr (std::same_as<T, Extended>) {
      p.t = t;
    } else {
      p.t = to_double(t);
    }
    p.q = E::Group::template cast<T>(system.configuration(s.R));
    p.v = rounded(system.velocity(s.R, s.omega));
    p.acceleration = rounded(system.acceleration(s.R, s.omega, s.omega_dot));
    p.lambda = rounded(system.multipliers(s.R, s.omega, s.omega_dot));
    return p;
  }

  static constexpr std::size_t degree = 32;
  struct Piece {
    std::array<Matrix, degree + 1> R;
    std::array<Vector, degree + 1> omega;
  };

  Piece expand(const Matrix& R, const Vector& omega) const;
  static State evaluate(const Piece& p, const Extended& s);

  HeavyTopParameters parameters_;
  HeavyTopSO3<Extended> system_;
  HeavyTopData<Extended> data_;
  double width_ = 0.0;
  std::vector<Piece> pieces_;
};

}  // namespace liebench
