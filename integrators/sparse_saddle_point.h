#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "integrators/audit.h"
#include "integrators/consistent_projection.h"
#include "integrators/patterned_matrix.h"
#include "problems/system.h"

// Saddle point matrices of systems of many bodies, put together from their blocks.

namespace liebench {

// A system that gives the blocks of its matrices, one body and constraint after the other: see SceneSystem.
template <class S>
concept BlockSystem = MechanicalSystem<S> && SizedLieGroup<typename S::Group> && requires(const S& s) {
  s.model().bodies;
  s.multipliers();
};

// The saddle point matrix of such a system with the constraint forces at q and the constraints at `next`,
//
//   [ M        B(q)^T ]
//   [ B(next)  0      ]
//
// in the scalar of the linear algebra.
template <BlockSystem S>
class SparseSaddlePoint {
 public:
  using T = typename S::Scalar;
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;

  explicit SparseSaddlePoint(const S& system)
      : m_(velocity_size(system)), matrix_(m_ + multiplier_size(system)) {}

  // False where it is singular, or not finite().
  bool factorize(const S& system, const Configuration<S>& q) {
    begin(system);
    Sink<true, true> sink{*this, system};
    system.gradient(q, sink);
    return matrix_.factorize();
  }
  bool factorize(const S& system, const Configuration<S>& q, const Configuration<S>& next) {
    begin(system);
    Sink<true, false> forces{*this, system};
    system.gradient(q, forces);
    Sink<false, true> constraints{*this, system};
    system.gradient(next, constraints);
    return matrix_.factorize();
  }
  bool finite() const { return matrix_.finite(); }
  void solve(Vector& r) const { matrix_.solve(r, r); }

 private:
  template <bool forces, bool constraints>
  struct Sink {
    SparseSaddlePoint& to;
    const S& system;
    template <class Block>
    void gradient(Eigen::Index row, int j, const Block& B) {
      const Eigen::Index v = system.model().bodies[std::size_t(j)].v;
      if constexpr (forces) to.matrix_.add_block(v, to.m_ + row, B.transpose());
      if constexpr (constraints) to.matrix_.add_block(to.m_ + row, v, B);
    }
  };
  void begin(const S& system) {
    matrix_.begin();
    for (const auto& body : system.model().bodies) matrix_.add_block(body.v, body.v, body.mass_matrix());
  }

  Eigen::Index m_;
  PatternedMatrix<T> matrix_;
};

// One pass of iterative refinement of (x, y) with M x + B(q)^T y = a, B(next) x = b.
template <BlockSystem S, BlockSystem LinearSystem, class Audit>
void refine_saddle_point(const S& system, const SparseSaddlePoint<LinearSystem>& matrix,
                         const Configuration<S>& q, const Configuration<S>& next, const Velocity<S>& a,
                         const Multipliers<S>& b, Velocity<S>& x, Multipliers<S>& y, Audit& audit) {
  using T = typename S::Scalar;
  using L = typename LinearSystem::Scalar;
  const Eigen::Index m = velocity_size(system), l = multiplier_size(system);
  typename SparseSaddlePoint<LinearSystem>::Vector r(m + l);
  r.head(m) = (a - system.momentum(q, x) - system.constraint_force(q, y)).template cast<L>();
  if (l > 0) r.tail(l) = (b - system.constraint_product(next, x)).template cast<L>();
  matrix.solve(r);
  audit.solve();
  x += r.head(m).template cast<T>();
  if (l > 0) y += r.tail(l).template cast<T>();
}

// Solved in the scalar of the linear algebra, of which `linear` is the system, and refined in that of the system.
template <BlockSystem S, BlockSystem LinearSystem, class Audit>
bool solve_sparse_saddle_point(const S& system, const LinearSystem& linear, const Configuration<S>& q,
                               const Velocity<S>& a, const Multipliers<S>& b, Velocity<S>& x,
                               Multipliers<S>& y, Audit& audit) {
  SparseSaddlePoint<LinearSystem> matrix(linear);
  audit.factorization(FactorizationCause::start);
  if (!matrix.factorize(linear, q.template cast<typename LinearSystem::Scalar>())) return false;
  x = zero_velocity(system);
  y = zero_multipliers(system);
  for (int pass = 0; pass < refinement_passes<typename S::Scalar>; ++pass)
    refine_saddle_point(system, matrix, q, q, a, b, x, y, audit);
  return true;
}

template <BlockSystem S, class Audit>
std::optional<SaddlePointSolution<S>> solve_saddle_point(const S& system, const Configuration<S>& q,
                                                         const Velocity<S>& a, const Multipliers<S>& b,
                                                         Audit& audit) {
  SaddlePointSolution<S> s{zero_velocity(system), zero_multipliers(system)};
  if (!solve_sparse_saddle_point(system, system, q, a, b, s.x, s.y, audit)) return std::nullopt;
  return s;
}

}  // namespace liebench
