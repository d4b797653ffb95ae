#pragma once

#include <Eigen/Core>
#include <type_traits>

#include "integrators/audit.h"
#include "integrators/consistent_projection.h"
#include "integrators/outcome.h"
#include "integrators/patterned_matrix.h"
#include "integrators/sparse_saddle_point.h"
#include "integrators/stage_solver.h"
#include "problems/system.h"

namespace liebench {

// The linear systems of half-explicit stages of many bodies: one sparse matrix a stage, of one pattern. M depends on
// nothing and is factorized once, for the first stage.
template <BlockSystem S>
class StageSolver<S> {
  using T = typename S::Scalar;
  using L = LinearScalar<T>;
  using LinearSystem = typename S::template rebind<L>;
  using Vector = typename SparseSaddlePoint<LinearSystem>::Vector;
  static constexpr int passes = ScalarTraits<T>::extended ? refinement_passes<T> : 1;

 public:
  explicit StageSolver(const S& system) requires std::is_same_v<T, L> : StageSolver(system, system) {}
  // `linear` is the same system in the scalar of the linear algebra.
  StageSolver(const S& system, const LinearSystem& linear)
      : linear_(linear), mass_(velocity_size(system)), matrix_(linear) {}

  template <class Audit>
  void prepare(const S&, Audit& audit) {
    audit.factorization(FactorizationCause::start);
    mass_.begin();
    for (const auto& body : linear_.model().bodies) mass_.add_block(body.v, body.v, body.mass_matrix());
    regular_ = mass_.factorize();
  }

  template <class Audit>
  bool mass_solve(const S& system, const Configuration<S>& q, const Velocity<S>& a, Velocity<S>& x,
                  Audit& audit) {
    if (!regular_) return false;
    x = zero_velocity(system);
    Velocity<S> r = a;
    for (int pass = 0; pass < passes; ++pass) {
      if (pass > 0) r = a - system.momentum(q, x);
      Vector dx = r.template cast<L>();
      mass_.solve(dx, dx);
      audit.solve();
      x += dx.template cast<T>();
    }
    return true;
  }

  void take(const S&, const Configuration<S>&) {}
  void shift(const S&, const Configuration<S>&) {}
  Multipliers<S> rate(const S& system, const T& t, const Configuration<S>& next, const Velocity<S>& v) const {
    return system.constraint_rate(t, next, v);
  }

  template <class Audit>
  Outcome factorize(const S&, const Configuration<S>& q, const Configuration<S>& next, Audit& audit) {
    audit.factorization(FactorizationCause::refresh);
    if (matrix_.factorize(linear_, q.template cast<L>(), next.template cast<L>())) return Outcome::ok;
    return matrix_.finite() ? Outcome::singular_matrix : Outcome::non_finite;
  }

  template <class Audit>
  void solve(const S& system, const Configuration<S>& q, const Configuration<S>& next, const Velocity<S>& a,
             const Multipliers<S>& b, Velocity<S>& x, Multipliers<S>& y, Audit& audit) const {
    const Eigen::Index m = a.size(), l = b.size();
    Vector r(m + l);
    r << a.template cast<L>(), b.template cast<L>();
    matrix_.solve(r);
    audit.solve();
    x = r.head(m).template cast<T>();
    y = r.tail(l).template cast<T>();
    for (int pass = 1; pass < passes; ++pass)
      refine_saddle_point(system, matrix_, q, next, a, b, x, y, audit);
  }

 private:
  LinearSystem linear_;
  PatternedMatrix<L> mass_;
  bool regular_ = false;
  SparseSaddlePoint<LinearSystem> matrix_;
};

}  // namespace liebench
