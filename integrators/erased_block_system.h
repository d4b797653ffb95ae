#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <variant>

#include "groups/audited_group.h"
#include "integrators/mass_solver.h"
#include "integrators/radau_matrix.h"
#include "integrators/run_time_system.h"
#include "integrators/sparse_radau_matrix.h"
#include "integrators/sparse_stage_solver.h"
#include "integrators/sparse_step_matrix.h"
#include "integrators/stage_solver.h"
#include "problems/audited_system.h"

namespace liebench {

// A Newton matrix of a system of many bodies behind the interface of all.
template <BlockSystem S, class Matrix>
class ErasedBlockMatrix final : public AnyStepMatrix<typename S::Scalar> {
  using T = typename S::Scalar;
  using Base = AnyStepMatrix<T>;

 public:
  using typename Base::Derivatives;
  using typename Base::Point;
  using typename Base::Vector;

  explicit ErasedBlockMatrix(const S& system) : system_(system), matrix_(system) {}
  Outcome factorize(const Point& p, const Derivatives& derivatives) override {
    return factorize_at(matrix_, p, derivatives);
  }
  Vector solve(const Vector& r) const override { return matrix_.solve(r); }
  T mass_scale() const override { return matrix_.mass_scale(); }
  double factorization_cost() const override { return matrix_.factorization_cost(); }
  double most_noise() const override { return matrix_.most_noise(); }
  std::unique_ptr<Base> clone() const override { return std::make_unique<ErasedBlockMatrix>(*this); }

 private:
  template <Form form>
  Outcome factorize_at(SparseStepMatrix<S, form>& matrix, const Point& p, const Derivatives& derivatives) {
    count(1);
    const Multipliers<S> lambda = p.scaled_lambda / p.h;
    return std::visit(
        [&](const auto& d) {
          return matrix.factorize_at(system_, p.t, p.h, p.q_n, p.step, p.q, p.velocity, lambda, d);
        },
        derivatives);
  }
  template <Form form>
  Outcome factorize_at(SparseRadauMatrix<S, form>& matrix, const Point& p, const Derivatives&) {
    const RadauStages<S> stages = radau_stages<S>(matrix.coefficients(), p, [](const auto& q) { return q; });
    count(stages.size());
    return matrix.factorize_at(system_, p.h, stages);
  }
  void count(std::uint64_t points) const {
    SystemCalls::counts().stiffnesses += points;
    GroupCalls::counts().tangent += points * system_.model().bodies.size();
  }

  S system_;
  Matrix matrix_;
};

// A system of many bodies as a RunTimeSystem; it counts its evaluations and, body by body, what AuditedGroup counts: here and not in
// the group, for that of the linear algebra of an audit is in double, as is the one that is timed. `linear` is the same system in
// the scalar of the linear algebra.
template <BlockSystem S>
class ErasedBlockSystem final : public AnySystem<typename S::Scalar> {
  using T = typename S::Scalar;
  using Base = AnySystem<T>;
  using typename Base::Linear;
  using LinearSystem = typename S::template rebind<Linear>;

 public:
  using typename Base::Vector;

  ErasedBlockSystem(const S& system, const LinearSystem& linear) : system_(system) {
    if constexpr (!std::is_same_v<T, Linear>)
      linear_ = std::make_unique<ErasedBlockSystem<LinearSystem>>(linear, linear);
  }

  Eigen::Index velocities() const override { return system_.group().size(); }
  Eigen::Index multipliers() const override { return system_.multipliers(); }
  bool commutative() const override { return system_.group().commutative(); }
  Vector identity() const override { return system_.group().identity(); }
  Vector compose(const Vector& p, const Vector& q) const override { return system_.group().compose(p, q); }
  Vector inverse(const Vector& q) const override { return system_.group().inverse(q); }
  Vector exp(const Vector& v) const override {
    GroupCalls::counts().exp += bodies();
    return system_.group().exp(v);
  }
  Vector log(const Vector& q) const override {
    GroupCalls::counts().log += bodies();
    return system_.group().log(q);
  }
  Vector commutator(const Vector& v, const Vector& w) const override {
    GroupCalls::counts().commutators += rotating_bodies();
    return system_.group().commutator(v, w);
  }
  BlockDiagonal<T> ad(const Vector& v) const override {
    GroupCalls::counts().commutators += rotating_bodies();
    return system_.group().ad(v);
  }
  BlockDiagonal<T> tangent(const Vector& v) const override {
    GroupCalls::counts().tangent += bodies();
    return system_.group().tangent(v);
  }
  BlockDiagonal<T> tangent_inverse(const Vector& v) const override {
    GroupCalls::counts().tangent_inverse += bodies();
    return system_.group().tangent_inverse(v);
  }
  Vector tangent_times(const Vector& v, const Vector& w) const override {
    GroupCalls::counts().tangent += bodies();
    return system_.group().tangent_times(v, w);
  }
  Vector tangent_inverse_times(const Vector& v, const Vector& w) const override {
    GroupCalls::counts().tangent_inverse += bodies();
    return system_.group().tangent_inverse_times(v, w);
  }
  Vector coadjoint(const Vector& v, const Vector& w) const override {
    GroupCalls::counts().commutators += rotating_bodies();
    return system_.group().coadjoint(v, w);
  }
  Vector tangent_inverse_transposed_change(const Vector& v, const Vector& w) const override {
    GroupCalls::counts().tangent_inverse += bodies();
    return system_.group().tangent_inverse_transposed_change(v, w);
  }
  Vector adjoint_transposed_change(const Vector& v, const Vector& w) const override {
    GroupCalls::counts().tangent += bodies();
    return system_.group().adjoint_transposed_change(v, w);
  }
  T rotation_angle(const Vector& v) const override { return system_.group().rotation_angle(v); }

  Vector momentum(const Vector& q, const Vector& w) const override { return system_.momentum(q, w); }
  Vector force(const T& t, const Vector& q, const Vector& v) const override {
    ++SystemCalls::counts().forces;
    return system_.force(t, q, v);
  }
  T energy(const Vector& q, const Vector& v) const override { return system_.energy(q, v); }
  T angular_momentum(const Vector& q, const Vector& v) const override {
    return system_.angular_momentum(q, v);
  }
  Vector initial_configuration() const override { return system_.initial_configuration(); }
  Vector initial_velocity() const override { return system_.initial_velocity(); }
  Vector constraint(const T& t, const Vector& q) const override { return system_.constraint(t, q); }
  Vector constraint_force(const Vector& q, const Vector& lambda) const override {
    return system_.constraint_force(q, lambda);
  }
  Vector constraint_product(const Vector& q, const Vector& w) const override {
    return system_.constraint_product(q, w);
  }
  Vector constraint_rate(const T& t, const Vector& q, const Vector& v) const override {
    return system_.constraint_rate(t, q, v);
  }
  Vector constraint_curvature(const T& t, const Vector& q, const Vector& v) const override {
    return system_.constraint_curvature(t, q, v);
  }
  bool saddle_point(const Vector& q, const Vector& a, const Vector& b, Vector& x, Vector& y,
                    KernelAudit& audit) const override {
    if constexpr (std::is_same_v<T, Linear>)
      return solve_sparse_saddle_point(system_, system_, q, a, b, x, y, audit);
    else
      return solve_sparse_saddle_point(system_, linear_->system_, q, a, b, x, y, audit);
  }

  bool constant_mass() const override { return false; }
  bool mass_solve(const Vector& q, const Vector& a, Vector& x, KernelAudit& audit) const override {
    return MassSolver<S>().solve(system_, q, a, x, audit);
  }
  std::unique_ptr<AnyStageSolver<T>> stage_solver() const override {
    if constexpr (std::is_same_v<T, Linear>)
      return std::make_unique<ErasedStageSolver<S>>(system_, StageSolver<S>(system_));
    else
      return std::make_unique<ErasedStageSolver<S>>(system_, StageSolver<S>(system_, linear_->system_));
  }

  const AnySystem<Linear>& linear() const override {
    if constexpr (std::is_same_v<T, Linear>)
      return *this;
    else
      return *linear_;
  }
  std::unique_ptr<AnyStepMatrix<T>> step_matrix(Form form) const override {
    if constexpr (!std::is_same_v<T, Linear>)
      return nullptr;  // asked of linear() only
    else
      return with_form<S>(form, [&]<Form f>(FormConstant<f>) -> std::unique_ptr<AnyStepMatrix<T>> {
        return std::make_unique<ErasedBlockMatrix<S, SparseStepMatrix<S, f>>>(system_);
      });
  }
  std::unique_ptr<AnyStepMatrix<T>> radau_matrix(Form form) const override {
    if constexpr (!std::is_same_v<T, Linear>)
      return nullptr;  // asked of linear() only
    else
      return with_form<S>(form, [&]<Form f>(FormConstant<f>) -> std::unique_ptr<AnyStepMatrix<T>> {
        return std::make_unique<ErasedBlockMatrix<S, SparseRadauMatrix<S, f>>>(system_);
      });
  }

 private:
  template <BlockSystem Other>
  friend class ErasedBlockSystem;
  std::uint64_t bodies() const { return system_.model().bodies.size(); }
  // Every commutator of a point mass vanishes, and none is computed.
  std::uint64_t rotating_bodies() const {
    const auto& all = system_.model().bodies;
    return std::uint64_t(std::count_if(all.begin(), all.end(), [](const auto& b) { return b.rotates(); }));
  }
  S system_;
  std::unique_ptr<ErasedBlockSystem<LinearSystem>> linear_;
};

}  // namespace liebench
