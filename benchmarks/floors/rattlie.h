#pragma once

#include <span>

#include "benchmarks/floors/momentum_top.h"
#include "benchmarks/floors/one_step.h"

namespace liebench::floors {

// What floors of steps that balance the momentum of the top on SO(3) share.
class SO3MomentumFloor : public SO3Floor {
 public:
  void start(double h, std::span<const SolutionPoint<System>> points) {
    SO3Floor::start(h, points);
    force_ = tip_force(q_.R);
    first_change_ = (0.5 * h) * from_eigen(points[0].acceleration);
  }

 protected:
  Vec3 force_{}, first_change_{};
};

// RATTLie of the top on SO(3): the method of Stoermer and Verlet.
class SO3Rattlie : public SO3MomentumFloor {
 public:
  bool step() {
    const double half = 0.5 * h_;
    const double* c = extrapolation[count_];
    Vec3 d = count_ > 0 ? c[0] * changes_[0] + c[1] * changes_[1] + c[2] * changes_[2] : first_change_;
    decltype(top_)::Solution s;
    if (!top_.solve(h_, {v_, about_tip(v_), half * force_}, d, s)) return false;
    t_ += h_;
    q_.R = q_.R * exp(s.turn);
    force_ = tip_force(q_.R);
    const Vec3 kicks = s.transported.even - s.transported.odd - half * force_;
    v_ = s.velocity + over_tip_inertia(kicks);
    changes_[2] = changes_[1];
    changes_[1] = changes_[0];
    changes_[0] = d;
    if (count_ < 3) ++count_;
    return true;
  }
  const KeptMatrix& kept() const { return top_.kept; }

 private:
  SO3MomentumTop<VariationalTransport> top_;
  Vec3 changes_[3]{};
  int count_ = 0;
};

// What RATTLie and SHAKELie of the constrained top share: each is one solution of its equation ahead.
class VariationalFloor : public TipFloor {
 public:
  void start(double h, std::span<const SolutionPoint<System>> points) {
    TipFloor::start(h, points);
    first_ = {(0.5 * h) * from_eigen(points[0].acceleration), (0.5 * h) * from_eigen(points[0].lambda)};
  }
  const KeptMatrix& kept() const { return top_.kept; }

 protected:
  using Solution = R3xSO3MomentumTop::Solution;

  // The third component of f, the only one.
  static constexpr double force = -top::weight;

  bool solve_from(const TipPoint& q, const R3xSO3MomentumTop::Equation& e, Solution& s) {
    const double* c = extrapolation[count_];
    const auto& z = solutions_;
    if (count_ > 0)
      s.z = {c[0] * z[0].d + c[1] * z[1].d + c[2] * z[2].d,
             c[0] * z[0].impulse + c[1] * z[1].impulse + c[2] * z[2].impulse};
    else
      s.z = first_;
    return top_.solve(h_, q, e, s);
  }
  bool solve_from_velocity(const TipPoint& q, const Vec6& v, Solution& s) {
    return solve_from(q, {v, about_center(v.w), {{0.0, 0.0, 0.5 * h_ * force}, {0.0, 0.0, 0.0}}}, s);
  }
  void keep(const R3xSO3MomentumTop::Unknowns& z) {
    solutions_[2] = solutions_[1];
    solutions_[1] = solutions_[0];
    solutions_[0] = z;
    if (count_ < 3) ++count_;
  }

  R3xSO3MomentumTop top_;
  Vec3 lambda_{};
  Solution ahead_{};
  bool is_ahead_ = false;

 private:
  R3xSO3MomentumTop::Unknowns first_{}, solutions_[3]{};
  int count_ = 0;
};

class R3xSO3Rattlie : public VariationalFloor {
 public:
  bool step() {
    if (!is_ahead_ && !solve_from_velocity(q_, v_, ahead_)) return false;
    is_ahead_ = true;
    const TipPoint q = ahead_.q;
    // Onto B v = 0: with M diagonal three equations are left.
    const Vec6 kicks{{0.0, 0.0, -0.5 * h_ * force * (1.0 / top::mass)},
                     over_inertia(ahead_.transported.even - ahead_.transported.odd)};
    ++top_.kept.factorizations;
    if (!projection_.factorize(q, q)) return false;
    const Vec6 v = ahead_.velocity + kicks;
    const Vec3 impulse = projection_.solve(rate(q, v));
    keep(ahead_.z);
    v_ = accelerated(q, v, impulse);
    if (!solve_from_velocity(q, v_, ahead_)) return false;
    lambda_ = (1.0 / h_) * (impulse + ahead_.z.impulse);
    t_ += h_;
    q_ = q;
    return true;
  }

 private:
  TipForce projection_;
};

}  // namespace liebench::floors
