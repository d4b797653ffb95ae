#pragma once

#include "groups/rigid_motions.h"
#include "groups/s3.h"

namespace liebench {

// S^3 |x R^3: rigid motions with unit quaternions, q = (x, p); (x, p) and (x, -p) are one motion.
// [Arnold & Hante 2017]
template <Scalar T>
struct S3R3 : RigidMotions<S3<T>> {
  template <class U>
  using rebind = S3R3<U>;
  static constexpr const char* name = "S3|xR3";
};

}  // namespace liebench
