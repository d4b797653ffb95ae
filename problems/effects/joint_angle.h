#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "groups/decimal.h"
#include "problems/scene_constraints.h"

namespace liebench {

// The angle of a revolute joint, as PrescribedAngle has it: that by which a direction e_b of b is turned from e_a towards
// n_a x e_a, both of a,
//
//   phi = atan2(S, C), S = (R_a (n_a x e_a)) . (R_b e_b), C = (R_a e_a) . (R_b e_b)
//
// Defined, with torques that are its gradient and so balance, where the axes of a and b differ, too.
template <class T>
struct JointAngle {
  using Vector = Eigen::Matrix<T, 3, 1>;
  Vector axis_a, reference_a;  // n_a and e_a, at a right angle; frame of a; of any length
  Vector reference_b;          // e_b, frame of b; of any length

  template <class U>
  JointAngle<U> cast() const {
    return {decimal_vector<U>(axis_a), decimal_vector<U>(reference_a), decimal_vector<U>(reference_b)};
  }

  // At one pair of states.
  template <class U>
  class At {
   public:
    At(const JointAngle& angle, const RigidState<U>& a, const RigidState<U>& b)
        : cosine_(a, b, angle.reference_a.template cast<U>(), angle.reference_b.template cast<U>()),
          sine_(a, b, angle.across_a().template cast<U>(), angle.reference_b.template cast<U>()),
          C_(cosine_.value()),
          S_(sine_.value()),
          square_(C_ * C_ + S_ * S_) {}

    // phi, in (-pi, pi].
    U value() const {
      using std::atan2;
      return atan2(S_, C_);
    }
    // phi - c to within (-pi, pi].
    U difference(const T& c) const {
      using std::atan2;
      using std::cos;
      using std::sin;
      const U cosine(cos(c)), sine(sin(c));
      return atan2(S_ * cosine - C_ * sine, C_ * cosine + S_ * sine);
    }
    // phi', rad/s.
    U rate() const { return (C_ * sine_.rate() - S_ * cosine_.rate()) / square_; }
    // The torques that do the work `torque` phi' on the bodies.
    void add_torques(const U& torque, Wrench<U>& on_a, Wrench<U>& on_b) const {
      sine_.add_torques(torque * C_ / square_, on_a, on_b);
      cosine_.add_torques(-torque * S_ / square_, on_a, on_b);
    }

   private:
    DirectionProduct<U> cosine_, sine_;
    U C_, S_, square_;
  };
  template <class U>
  At<U> at(const RigidState<U>& a, const RigidState<U>& b) const {
    return At<U>(*this, a, b);
  }

 private:
  Vector across_a() const { return axis_a.cross(reference_a) / axis_a.norm(); }
};

}  // namespace liebench
