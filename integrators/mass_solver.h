#pragma once

#include "integrators/audit.h"
#include "integrators/consistent_projection.h"
#include "integrators/dense_lu.h"
#include "integrators/run_time_system.h"
#include "problems/system.h"

namespace liebench {

// M(q) x = a, for methods that need no other matrix. What depends on nothing is factorized once, in prepare();
// refined in extended precision. solve() is false where M is singular.
template <MechanicalSystem S>
class MassSolver {
  using T = typename S::Scalar;

 public:
  template <class Audit>
  void prepare(const S&, Audit&) {}

  // Of a scene, body by body.
  template <class Audit>
  bool solve(const S& system, const Configuration<S>&, const Velocity<S>& a, Velocity<S>& x, Audit& audit) {
    audit.solve();
    x.resize(a.size());
    for (const auto& body : system.model().bodies) {
      const auto M = body.mass_matrix();
      if (!(M.rows() == 3 ? solve_body<3>(M, body.v, a, x) : solve_body<6>(M, body.v, a, x))) return false;
    }
    return true;
  }

 private:
  template <int n, class Block>
  static bool solve_body(const Block& M, Eigen::Index v, const Velocity<S>& a, Velocity<S>& x) {
    DenseLu<T, n> lu;
    if (!lu.factorize(M)) return false;
    x.template segment<n>(v) = lu.solve(a.template segment<n>(v));
    return true;
  }
};

template <DenseSystem S>
class MassSolver<S> {
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  static constexpr int passes = ScalarTraits<T>::extended ? refinement_passes<T> : 1;

 public:
  template <class Audit>
  void prepare(const S& system, Audit& audit) {
    if constexpr (S::constant_mass) factorize(system, system.initial_configuration(), audit);
  }

  template <class Audit>
  bool solve(const S& system, const Configuration<S>& q, const Velocity<S>& a, Velocity<S>& x, Audit& audit) {
    if constexpr (!S::constant_mass) factorize(system, q, audit);
    if (!regular_) return false;
    x = lu_.solve(a.template cast<Linear>()).template cast<T>();
    audit.solve();
    for (int pass = 1; pass < passes; ++pass) {
      const Velocity<S> r = a - system.momentum(q, x);
      x += lu_.solve(r.template cast<Linear>()).template cast<T>();
      audit.solve();
    }
    return true;
  }

 private:
  template <class Audit>
  void factorize(const S& system, const Configuration<S>& q, Audit& audit) {
    audit.factorization(FactorizationCause::start);
    const VelocityMatrix<S> M = system.mass_matrix(q);
    regular_ = lu_.factorize(M.template cast<Linear>());
  }

  DenseLu<Linear, S::Group::dimension> lu_;
  bool regular_ = false;
};

template <class T>
class MassSolver<RunTimeSystem<T>> {
  using S = RunTimeSystem<T>;

 public:
  template <class Audit>
  void prepare(const S& system, Audit& audit) {
    if (system.constant_mass()) audit.factorization(FactorizationCause::start);
  }
  template <class Audit>
  bool solve(const S& system, const Configuration<S>& q, const Velocity<S>& a, Velocity<S>& x, Audit& audit) {
    return system.mass_solve(q, a, x, audit);
  }
};

}  // namespace liebench
