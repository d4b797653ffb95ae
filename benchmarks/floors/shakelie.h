#pragma once

#include "benchmarks/floors/rattlie.h"

namespace liebench::floors {

// SHAKELie of the constrained top.
class R3xSO3Shakelie : public VariationalFloor {
 public:
  bool step() {
    if (!is_ahead_) {
      if (!solve_from_velocity(q_, v_, ahead_)) return false;
      is_ahead_ = true;
      keep({2.0 * ahead_.z.d, 2.0 * ahead_.z.impulse});
    }
    const TipPoint q = ahead_.q;
    const Vec6 increment = ahead_.velocity;
    const Vec3 transported = ahead_.transported.even - ahead_.transported.odd;
    if (!solve_from(q, {increment, ahead_.momentum, {{0.0, 0.0, h_ * force}, -1.0 * transported}}, ahead_))
      return false;
    const Vec6 kicks{{0.0, 0.0, -0.5 * h_ * force * (1.0 / top::mass)}, over_inertia(transported)};
    v_ = accelerated(q, increment + kicks, 0.5 * ahead_.z.impulse);
    keep(ahead_.z);
    lambda_ = (1.0 / h_) * ahead_.z.impulse;
    t_ += h_;
    q_ = q;
    return true;
  }
};

}  // namespace liebench::floors
