#pragma once

#include <cstdint>

#include "groups/lie_group.h"

// A group whose functions count their calls, for audit runs: at its boundary, so that no caller can be missed. What a group
// calls within itself (SE(3) the rotations, a product its factors) is its own affair and not counted.

namespace liebench {

struct GroupCalls {
  std::uint64_t exp = 0;
  std::uint64_t log = 0;
  std::uint64_t tangent = 0;          // T(v), T(v) w, A T(v); Ad(exp(v~))^T w
  std::uint64_t tangent_inverse = 0;  // T(v)^{-1}, T(v)^{-1} w, T(v)^{-T} w
  std::uint64_t commutators = 0;      // [v, w], ad(v)^T w, and ad(v), the matrix

  // Of this thread, since it began.
  static GroupCalls& counts() {
    thread_local GroupCalls counts;
    return counts;
  }
};

inline GroupCalls operator-(const GroupCalls& a, const GroupCalls& b) {
  return {a.exp - b.exp, a.log - b.log, a.tangent - b.tangent, a.tangent_inverse - b.tangent_inverse,
          a.commutators - b.commutators};
}

template <LieGroup G>
struct AuditedGroup : G {
  using typename G::Element;
  using typename G::Tangent;
  using typename G::TangentMatrix;
  template <class U>
  using rebind = AuditedGroup<typename G::template rebind<U>>;

  static Element exp(const Tangent& v) {
    ++GroupCalls::counts().exp;
    return G::exp(v);
  }
  static Tangent log(const Element& q) {
    ++GroupCalls::counts().log;
    return G::log(q);
  }
  static Tangent commutator(const Tangent& v, const Tangent& w) {
    ++GroupCalls::counts().commutators;
    return G::commutator(v, w);
  }
  static TangentMatrix ad(const Tangent& v) {
    ++GroupCalls::counts().commutators;
    return G::ad(v);
  }
  static TangentMatrix tangent(const Tangent& v) {
    ++GroupCalls::counts().tangent;
    return G::tangent(v);
  }
  static Tangent tangent_times(const Tangent& v, const Tangent& w) {
    ++GroupCalls::counts().tangent;
    return G::tangent_times(v, w);
  }
  static Tangent tangent_inverse_times(const Tangent& v, const Tangent& w) {
    ++GroupCalls::counts().tangent_inverse;
    return G::tangent_inverse_times(v, w);
  }
  static Tangent coadjoint(const Tangent& v, const Tangent& w) {
    ++GroupCalls::counts().commutators;
    return G::coadjoint(v, w);
  }
  static Tangent tangent_inverse_transposed_change(const Tangent& v, const Tangent& w) {
    ++GroupCalls::counts().tangent_inverse;
    return G::tangent_inverse_transposed_change(v, w);
  }
  static Tangent adjoint_transposed_change(const Tangent& v, const Tangent& w) {
    ++GroupCalls::counts().tangent;
    return G::adjoint_transposed_change(v, w);
  }
  template <class Matrix>
  static auto times_tangent(const Matrix& A, const Tangent& v) {
    ++GroupCalls::counts().tangent;
    return G::times_tangent(A, v);
  }
  static TangentMatrix tangent_inverse(const Tangent& v) {
    ++GroupCalls::counts().tangent_inverse;
    return G::tangent_inverse(v);
  }
};

}  // namespace liebench
