#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>

#include "integrators/audit.h"
#include "integrators/consistent_projection.h"
#include "integrators/dense_lu.h"
#include "integrators/outcome.h"
#include "integrators/run_time_system.h"
#include "problems/system.h"

namespace liebench {

// The linear systems of half-explicit stages, with the equations of motion at one configuration q and the constraints
// at another one,
//
//   [ M(q)     B(q)^T ] [ x ]   [ a ]
//   [ B(next)  0      ] [ y ] = [ b ]
//
// and M(q) x = a. One goes from point to point:
//
//   prepare(system, audit)                 once
//   mass_solve(system, q, a, x, audit)     M(q) x = a; false where M is singular
//   take(system, next)                     the constraints at this point: the rows
//   shift(system, q)                       q was `next`: the forces of the rows are the columns
//   rate(system, t, next, v)               B(next) v + Phi_t
//   factorize(system, q, next, audit)      Outcome::singular_matrix where the rows or M are
//   solve(system, q, next, a, b, x, y, audit)
//
// with the q and next of the last shift() and take(). Solved in the scalar of the linear algebra, refined in that of
// the system.
template <MechanicalSystem S>
class StageSolver;

// By the Schur complement B(next) M^{-1} B(q)^T, l x l: the inverse of M, block by block, is formed once where M
// depends on nothing, and B at each point once.
template <DenseSystem S>
class StageSolver<S> {
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  static constexpr int m = S::Group::dimension, l = S::constraints, block = mass_block<S>();
  static constexpr int passes = ScalarTraits<T>::extended ? refinement_passes<T> : 1;
  using Block = Eigen::Matrix<Linear, block, block>;
  using Force = Eigen::Matrix<Linear, m, 1>;
  using Rate = Eigen::Matrix<Linear, l, 1>;

 public:
  explicit StageSolver(const S&) {
    inverse_.fill(Block::Zero());
    rows_.setZero();
    accelerations_.setZero();
  }

  template <class Audit>
  void prepare(const S& system, Audit& audit) {
    if constexpr (S::constant_mass) {
      audit.factorization(FactorizationCause::start);
      invert_mass(system, system.initial_configuration());
    }
  }

  template <class Audit>
  bool mass_solve(const S& system, const Configuration<S>& q, const Velocity<S>& a, Velocity<S>& x,
                  Audit& audit) {
    if constexpr (!S::constant_mass) {
      audit.factorization(FactorizationCause::refresh);
      invert_mass(system, q);
    }
    if (!regular_) return false;
    x = mass_inverse_times(linear(a)).template cast<T>();
    audit.solve();
    for (int pass = 1; pass < passes; ++pass) {
      const Velocity<S> r = a - system.momentum(q, x);
      x += mass_inverse_times(linear(r)).template cast<T>();
      audit.solve();
    }
    return true;
  }

  void take(const S& system, const Configuration<S>& next) { rows_ = system.constraint_gradient(next); }
  void shift(const S& system, const Configuration<S>& q) {
    if constexpr (!S::constant_mass) invert_mass(system, q);
    for (int i = 0; i < m; i += block)
      accelerations_.template middleRows<block>(i) = inverse_[std::size_t(i / block)].lazyProduct(
          rows_.template middleCols<block>(i).transpose().template cast<Linear>());
  }
  Multipliers<S> rate(const S& system, const T& t, const Configuration<S>& next, const Velocity<S>& v) const {
    if constexpr (requires { system.constraint_rate(t, next, v); })
      return system.constraint_rate(t, next, v);
    else
      return rows_ * v;
  }

  template <class Audit>
  Outcome factorize(const S&, const Configuration<S>&, const Configuration<S>&, Audit& audit) {
    audit.factorization(FactorizationCause::refresh);
    if (!regular_) return Outcome::singular_matrix;
    const Complement A = rows_.template cast<Linear>().lazyProduct(accelerations_);
    if (complement_.factorize(A)) return Outcome::ok;
    return A.allFinite() ? Outcome::singular_matrix : Outcome::non_finite;
  }

  template <class Audit>
  void solve(const S& system, const Configuration<S>& q, const Configuration<S>&, const Velocity<S>& a,
             const Multipliers<S>& b, Velocity<S>& x, Multipliers<S>& y, Audit& audit) const {
    Force dx;
    Rate dy;
    solve_linear(linear(a), linear(b), dx, dy);
    audit.solve();
    x = dx.template cast<T>();
    y = dy.template cast<T>();
    for (int pass = 1; pass < passes; ++pass) {
      const Velocity<S> r = a - system.momentum(q, x) - system.constraint_force(q, y);
      const Multipliers<S> s = b - rows_ * x;
      solve_linear(linear(r), linear(s), dx, dy);
      audit.solve();
      x += dx.template cast<T>();
      y += dy.template cast<T>();
    }
  }

 private:
  using Complement = typename DenseLu<Linear, l>::Matrix;

  template <class Vector>
  static auto linear(const Vector& v) {
    return v.template cast<Linear>().eval();
  }

  void invert_mass(const S& system, const Configuration<S>& q) {
    const VelocityMatrix<S> M = system.mass_matrix(q);
    regular_ = true;
    for (int i = 0; i < m; i += block) {
      DenseLu<Linear, block> lu;
      regular_ = regular_ && lu.factorize(M.template block<block, block>(i, i).template cast<Linear>());
      if (!regular_) return;
      auto& inverse = inverse_[std::size_t(i / block)];
      for (int j = 0; j < block; ++j) inverse.col(j) = lu.solve(DenseLu<Linear, block>::Vector::Unit(j));
    }
  }
  Force mass_inverse_times(const Force& a) const {
    Force x;
    for (int i = 0; i < m; i += block)
      x.template segment<block>(i) =
          inverse_[std::size_t(i / block)].lazyProduct(a.template segment<block>(i));
    return x;
  }
  // x = M^{-1} (a - B(q)^T y), and so B(next) M^{-1} B(q)^T y = B(next) M^{-1} a - b.
  void solve_linear(const Force& a, const Rate& b, Force& x, Rate& y) const {
    const Force free = mass_inverse_times(a);
    y = complement_.solve(rows_.template cast<Linear>().lazyProduct(free) - b);
    x = free - accelerations_.lazyProduct(y);
  }

  std::array<Block, std::size_t(m / block)> inverse_;
  bool regular_ = false;
  ConstraintGradient<S> rows_;
  Eigen::Matrix<Linear, m, l> accelerations_;  // M^{-1} B(q)^T
  DenseLu<Linear, l> complement_;
};

template <class T>
class StageSolver<RunTimeSystem<T>> {
  using S = RunTimeSystem<T>;
  using Vector = typename S::Vector;

 public:
  explicit StageSolver(const S& system) : solver_(system.stage_solver()) {}
  StageSolver(const StageSolver& other) : solver_(other.solver_->clone()) {}
  StageSolver& operator=(const StageSolver& other) {
    solver_ = other.solver_->clone();
    return *this;
  }
  StageSolver(StageSolver&&) noexcept = default;
  StageSolver& operator=(StageSolver&&) noexcept = default;
  ~StageSolver() = default;

  void prepare(const S&, KernelAudit& audit) { solver_->prepare(audit); }
  bool mass_solve(const S&, const Vector& q, const Vector& a, Vector& x, KernelAudit& audit) {
    return solver_->mass_solve(q, a, x, audit);
  }
  void take(const S&, const Vector& next) { solver_->take(next); }
  void shift(const S&, const Vector& q) { solver_->shift(q); }
  Vector rate(const S&, const T& t, const Vector& next, const Vector& v) const {
    return solver_->rate(t, next, v);
  }
  Outcome factorize(const S&, const Vector& q, const Vector& next, KernelAudit& audit) {
    return solver_->factorize(q, next, audit);
  }
  void solve(const S&, const Vector& q, const Vector& next, const Vector& a, const Vector& b, Vector& x,
             Vector& y, KernelAudit& audit) const {
    solver_->solve(q, next, a, b, x, y, audit);
  }

 private:
  std::unique_ptr<AnyStageSolver<T>> solver_;
};

// Behind the interface of all; `element` makes an element of the group of its stacked representation.
template <MechanicalSystem S>
class ErasedStageSolver final : public AnyStageSolver<typename S::Scalar> {
  using T = typename S::Scalar;
  using Base = AnyStageSolver<T>;

 public:
  using typename Base::Vector;

  ErasedStageSolver(const S& system, const StageSolver<S>& solver) : system_(system), solver_(solver) {}

  void prepare(KernelAudit& audit) override { solver_.prepare(system_, audit); }
  bool mass_solve(const Vector& q, const Vector& a, Vector& x, KernelAudit& audit) override {
    Velocity<S> solution;
    if (!solver_.mass_solve(system_, element(q), Velocity<S>(a), solution, audit)) return false;
    x = solution;
    return true;
  }
  void take(const Vector& next) override { solver_.take(system_, element(next)); }
  void shift(const Vector& q) override { solver_.shift(system_, element(q)); }
  Vector rate(const T& t, const Vector& next, const Vector& v) const override {
    return solver_.rate(system_, t, element(next), Velocity<S>(v));
  }
  Outcome factorize(const Vector& q, const Vector& next, KernelAudit& audit) override {
    return solver_.factorize(system_, element(q), element(next), audit);
  }
  void solve(const Vector& q, const Vector& next, const Vector& a, const Vector& b, Vector& x, Vector& y,
             KernelAudit& audit) const override {
    Velocity<S> velocity;
    Multipliers<S> multipliers;
    solver_.solve(system_, element(q), element(next), Velocity<S>(a), Multipliers<S>(b), velocity,
                  multipliers, audit);
    x = velocity;
    y = multipliers;
  }
  std::unique_ptr<Base> clone() const override { return std::make_unique<ErasedStageSolver>(*this); }

 private:
  static decltype(auto) element(const Vector& q) {
    if constexpr (SizedLieGroup<typename S::Group>)
      return (q);
    else
      return S::Group::unstacked(q);
  }

  S system_;
  StageSolver<S> solver_;
};

}  // namespace liebench
