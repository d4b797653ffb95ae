#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
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
  HeavyTopMotion(const HeavyTopParameters& parameters, double end, double refinement = 1.0)
      : parameters_(parameters), system_(parameters), data_(parameters) {
    const double speed = to_double(data_.omega0.norm());
    width_ = 1.0 / ((8.0 + 4.0 * speed) * refinement);
    State state{data_.R0, data_.omega0, data_.omega0};
    for (int i = 0; i * width_ <= end; ++i) {
      pieces_.push_back(expand(state.R, state.omega));
      state = evaluate(pieces_.back(), Extended(width_));
    }
  }

  State at(const Extended& t) const {
    const auto last = pieces_.size() - 1;
    const auto piece = std::min(last, std::size_t(std::max(0.0, to_double(t) / width_)));
    return evaluate(pieces_[piece], t - Extended(double(piece)) * width_);
  }

  // The same as a point of the solution of `system`, a heavy top in any formulation and scalar that
  // is rounded from Extended.
  template <MechanicalSystem S>
  SolutionPoint<S> point(const S&, const Extended& t) const {
    using T = typename S::Scalar;
    using E = typename S::template rebind<Extended>;
    const E system = E(parameters_);
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

  // Kinetic plus potential energy [J].
  Extended energy(const State& s) const { return system_.energy(s.R, s.omega); }

 private:
  static constexpr std::size_t degree = 32;
  struct Piece {
    std::array<Matrix, degree + 1> R;
    std::array<Vector, degree + 1> omega;
  };

  Piece expand(const Matrix& R, const Vector& omega) const {
    const Matrix J = data_.inertia_about_tip();
    const Matrix inverse = J.inverse();
    const Vector weight = data_.gravity * data_.mass;
    Piece p;
    p.R[0] = R;
    p.omega[0] = omega;
    for (std::size_t j = 0; j < degree; ++j) {
      Matrix spin = Matrix::Constant(Extended(0.0));
      Vector moment = data_.center_of_mass.cross(p.R[j].transpose() * weight);
      for (std::size_t i = 0; i <= j; ++i) {
        spin += p.R[i] * skew(p.omega[j - i]);
        moment += (J * p.omega[i]).cross(p.omega[j - i]);
      }
      const Extended factor = Extended(1.0) / Extended(double(j + 1));
      p.R[j + 1] = spin * factor;
      p.omega[j + 1] = inverse * moment * factor;
    }
    return p;
  }

  static State evaluate(const Piece& p, const Extended& s) {
    State state{p.R[degree], p.omega[degree], p.omega[degree] * Extended(double(degree))};
    for (std::size_t j = degree; j-- > 0;) {
      state.R = state.R * s + p.R[j];
      state.omega = state.omega * s + p.omega[j];
      if (j > 0) state.omega_dot = state.omega_dot * s + p.omega[j] * Extended(double(j));
    }
    return state;
  }

  HeavyTopParameters parameters_;
  HeavyTopSO3<Extended> system_;
  HeavyTopData<Extended> data_;
  double width_ = 0.0;
  std::vector<Piece> pieces_;
};

}  // namespace liebench
