#pragma once

#include "benchmarks/floors/one_step.h"

namespace liebench::floors {

// What floors of one-step methods of the top on SO(3) share that solve for a change of velocity.
class SymmetricFloor : public SO3Floor {
 public:
  const KeptMatrix& kept() const { return top_.kept; }

 protected:
  Vec3 extrapolated() const {
    const double* c = extrapolation[count_];
    return c[0] * changes_[0] + c[1] * changes_[1] + c[2] * changes_[2];
  }
  void keep(const Vec3& change) {
    changes_[2] = changes_[1];
    changes_[1] = changes_[0];
    changes_[0] = change;
    if (count_ < 3) ++count_;
  }

  SO3Top top_;
  Vec3 changes_[3]{};
  int count_ = 0;
};

// Newmark's method with beta = 1/4, gamma = 1/2.
class Newmark : public SymmetricFloor {
 public:
  void start(double h, std::span<const SolutionPoint<System>> points) {
    SO3Floor::start(h, points);
    scaled_acceleration_ = h * from_eigen(points[0].acceleration);
  }

  bool step() {
    const AffineClosure<Vec3> closure{.base = v_ + 0.5 * scaled_acceleration_,
                                      .velocity = v_,
                                      .velocity_change = scaled_acceleration_,
                                      .scaled_acceleration = scaled_acceleration_,
                                      .velocity_slope = 2.0,
                                      .acceleration_slope = 4.0};
    SO3Top::Unknowns z{extrapolated()};
    SO3Top::Solution s;
    if (!top_.solve(h_, q_, closure, z, s) || turns_too_far(s.turn)) return false;
    t_ += h_;
    v_ = v_ + s.velocity_change;
    scaled_acceleration_ = s.scaled_acceleration;
    keep(z.d);
    return true;
  }

 private:
  Vec3 scaled_acceleration_{};
};

// The implicit midpoint rule: the implicit Euler method over h / 2 and its mirror image.
class ImplicitMidpoint : public SymmetricFloor {
 public:
  void start(double h, std::span<const SolutionPoint<System>> points) {
    SO3Floor::start(h, points);
    first_change_ = (0.5 * h) * from_eigen(points[0].acceleration);
  }

  bool step() {
    const EulerClosure closure{.base = v_, .velocity = v_};
    SO3Top::Unknowns z{count_ > 0 ? extrapolated() : first_change_};
    SO3Top::Solution s;
    if (!top_.solve(0.5 * h_, q_, closure, z, s) || turns_too_far(2.0 * s.turn)) return false;
    t_ += h_;
    q_.R = q_.R * s.motion;
    v_ = v_ + 2.0 * z.d;
    keep(z.d);
    return true;
  }

 private:
  // v = v_n + d, h v' = d
  struct EulerClosure {
    Vec3 base, velocity;

    void evaluate(double, const Vec3& d, SO3Top::Solution& s) const {
      s.velocity_change = d;
      s.scaled_acceleration = d;
    }
    Mat3 velocity_derivative(double, const Vec3&) const { return diagonal(1.0, 1.0, 1.0); }
    Mat3 acceleration_derivative(double, const Vec3&) const { return diagonal(1.0, 1.0, 1.0); }
  };

  Vec3 first_change_{};
};

}  // namespace liebench::floors
