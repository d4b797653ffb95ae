#pragma once

#include <cstdint>

#include "groups/audited_group.h"
#include "problems/system.h"

namespace liebench {

// Evaluations of a system, by what each of them needs exactly once.
struct SystemCalls {
  std::uint64_t forces = 0;       // g(t, q, v): residuals of the equations of motion
  std::uint64_t stiffnesses = 0;  // K: Newton matrices

  // Of this thread, since it began.
  static SystemCalls& counts() {
    thread_local SystemCalls counts;
    return counts;
  }
};

inline SystemCalls operator-(const SystemCalls& a, const SystemCalls& b) {
  return {a.forces - b.forces, a.stiffnesses - b.stiffnesses};
}

// What is evaluated on this thread during its life is not counted: of a reference beside an audit.
class Uncounted {
 public:
  Uncounted() = default;
  Uncounted(const Uncounted&) = delete;
  Uncounted& operator=(const Uncounted&) = delete;
  ~Uncounted() {
    SystemCalls::counts() = system_;
    GroupCalls::counts() = group_;
  }

 private:
  SystemCalls system_ = SystemCalls::counts();
  GroupCalls group_ = GroupCalls::counts();
};

// The system S on a group that counts its calls; it counts its own evaluations. For audit runs.
template <MechanicalSystem S>
class Audited : public S {
 public:
  using typename S::Scalar;
  using Group = AuditedGroup<typename S::Group>;
  using Element = typename Group::Element;
  using Tangent = typename Group::Tangent;
  using Multipliers = Eigen::Matrix<Scalar, S::constraints, 1>;
  template <class U>
  using rebind = Audited<typename S::template rebind<U>>;

  using S::S;
  explicit Audited(const S& system) : S(system) {}

  template <class U>
  rebind<U> cast() const {
    return rebind<U>(S::template cast<U>());
  }
  auto force(const Scalar& t, const Element& q, const Tangent& v) const {
    ++SystemCalls::counts().forces;
    return S::force(t, q, v);
  }
  auto stiffness(const Scalar& t, const Element& q, const Tangent& v, const Tangent& a,
                 const Multipliers& lambda) const {
    ++SystemCalls::counts().stiffnesses;
    return S::stiffness(t, q, v, a, lambda);
  }
};

}  // namespace liebench
