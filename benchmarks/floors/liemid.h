#pragma once

#include "benchmarks/floors/rattlie.h"

namespace liebench::floors {

// LIEMID of the top on SO(3), the free body in `parts` steps.
template <int parts>
class SO3Liemid : public SO3MomentumFloor {
 public:
  bool step() {
    const double width = h_ / parts, half = 0.5 * h_;
    Mat3 R = q_.R;
    Vec3 turned{0.0, 0.0, 0.0}, changes[parts];
    SO3MomentumTop<AdjointTransport>::Equation e{v_, about_tip(v_), half * force_};
#pragma GCC unroll 2
    for (int part = 0; part < parts; ++part) {
      const double* c = extrapolation[count_];
      const Vec3* before = changes_[part];
      Vec3& d = changes[part];
      if (count_ > 0)
        d = c[0] * before[0] + c[1] * before[1] + c[2] * before[2];
      else
        d = part == 0 ? first_change_ : Vec3{0.0, 0.0, 0.0};
      SO3MomentumTop<AdjointTransport>::Solution s;
      if (!top_.solve(width, e, d, s)) return false;
      R = R * exp(s.turn);
      turned = turned + s.turn;
      e = {s.velocity, s.momentum, s.transported.odd - s.transported.even};
    }
    if (turns_too_far(turned)) return false;
    t_ += h_;
    q_.R = R;
    force_ = tip_force(R);
    v_ = e.base - over_tip_inertia(e.known + half * force_);
    for (int part = 0; part < parts; ++part) {
      Vec3* before = changes_[part];
      before[2] = before[1];
      before[1] = before[0];
      before[0] = changes[part];
    }
    if (count_ < 3) ++count_;
    return true;
  }
  const KeptMatrix& kept() const {
    return top_.kept;
  }

 private:
  SO3MomentumTop<AdjointTransport> top_;
  Vec3 changes_[parts][3]{};
  int count_ = 0;
};

}  // namespace liebench::floors
