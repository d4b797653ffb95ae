#pragma once

#include "groups/rigid_motions.h"

namespace liebench {

// SE(3): rigid motions with rotation matrices, q = (x, R). [Bruels, Arnold & Cardona 2011]
template <Scalar T>
struct SE3 : RigidMotions<SO3<T>> {
  template <class U>
  using rebind = SE3<U>;
  static constexpr const char* name = "SE3";
};

}  // namespace liebench
