#include "tests/support/heavy_top_motion.h"

#include <Eigen/LU>
#include <algorithm>

namespace liebench {

HeavyTopMotion::HeavyTopMotion(const HeavyTopParameters& parameters, double end, double refinement)
    : parameters_(parameters), system_(parameters), data_(parameters) {
  const double speed = to_double(data_.omega0.norm());
  width_ = 1.0 / ((8.0 + 4.0 * speed) * refinement);
  State state{data_.R0, data_.omega0, data_.omega0};
  for (int i = 0; i * width_ <= end; ++i) {
    pieces_.push_back(expand(state.R, state.omega));
    state = evaluate(pieces_.back(), Extended(width_));
  }
}

HeavyTopMotion::State HeavyTopMotion::at(const Extended& t) const {
  const auto last = pieces_.size() - 1;
  const auto piece = std::min(last, std::size_t(std::max(0.0, to_double(t) / width_)));
  return evaluate(pieces_[piece], t - Extended(double(piece)) * width_);
}

Extended HeavyTopMotion::energy(const State& s) const {
  return system_.energy(s.R, s.omega);
}

HeavyTopMotion::Piece HeavyTopMotion::expand(const Matrix& R, const Vector& omega) const {
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

HeavyTopMotion::State HeavyTopMotion::evaluate(const Piece& p, const Extended& s) {
  State state{p.R[degree], p.omega[degree], p.omega[degree] * Extended(double(degree))};
  for (std::size_t j = degree; j-- > 0;) {
    state.R = state.R * s + p.R[j];
    state.omega = state.omega * s + p.omega[j];
    if (j > 0) state.omega_dot = state.omega_dot * s + p.omega[j] * Extended(double(j));
  }
  return state;
}

}  // namespace liebench
