#pragma once

#include <Eigen/Core>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "integrators/consistent_projection.h"
#include "integrators/mass_solver.h"
#include "integrators/radau_matrix.h"
#include "integrators/run_time_system.h"
#include "integrators/stage_solver.h"
#include "integrators/step_matrix.h"

namespace liebench {

// A Newton matrix of a system of fixed size behind the interface of all.
template <DenseSystem S, class Matrix>
class ErasedStepMatrix final : public AnyStepMatrix<typename S::Scalar> {
  using T = typename S::Scalar;
  using Base = AnyStepMatrix<T>;

 public:
  using typename Base::Derivatives;
  using typename Base::Point;
  using typename Base::Vector;

  explicit ErasedStepMatrix(const S& system) : system_(system), matrix_(system) {}
  Outcome factorize(const Point& p, const Derivatives& derivatives) override {
    return factorize_erased(matrix_, system_, p, derivatives);
  }
  Vector solve(const Vector& r) const override { return matrix_.solve(r); }
  T mass_scale() const override { return matrix_.mass_scale(); }
  double factorization_cost() const override { return matrix_.factorization_cost(); }
  double most_noise() const override { return matrix_.most_noise(); }
  std::unique_ptr<Base> clone() const override { return std::make_unique<ErasedStepMatrix>(*this); }

 private:
  S system_;
  Matrix matrix_;
};

template <DenseSystem S, Form form>
Outcome factorize_erased(DenseStepMatrix<S, form>& matrix, const S& system,
                         const typename AnyStepMatrix<typename S::Scalar>::Point& p,
                         const typename AnyStepMatrix<typename S::Scalar>::Derivatives& derivatives) {
  using T = typename S::Scalar;
  using Equation = typename DenseStepMatrix<S, form>::Equation;
  typename Equation::Point point;
  point.step = p.step;
  point.q = S::Group::unstacked(p.q);
  point.values.velocity = p.velocity;
  point.values.scaled_acceleration = p.scaled_acceleration;
  typename Equation::Unknowns z = Equation::Unknowns::Constant(T(0.0));
  Equation::scaled_lambda(z, system) = p.scaled_lambda;
  const auto q_n = S::Group::unstacked(p.q_n);
  const auto with = [&](const auto& d) { return matrix.factorize_at(system, p.t, p.h, q_n, d, point, z); };
  if (const auto* scalar = std::get_if<ClosureDerivatives<T>>(&derivatives)) return with(*scalar);
  if constexpr (form == Form::index3)
    if (const auto* scalar = std::get_if<ClosureDerivatives<T, true>>(&derivatives)) return with(*scalar);
  const auto& blocks = std::get<ClosureDerivatives<BlockDiagonal<T>>>(derivatives);
  return with(ClosureDerivatives<VelocityMatrix<S>>{blocks.velocity.blocks().front(),
                                                    blocks.scaled_acceleration.blocks().front()});
}

template <DenseSystem S, Form form>
Outcome factorize_erased(DenseRadauMatrix<S, form>& matrix, const S& system,
                         const typename AnyStepMatrix<typename S::Scalar>::Point& p,
                         const typename AnyStepMatrix<typename S::Scalar>::Derivatives&) {
  return matrix.factorize_at(system, p.h, radau_stages<S>(matrix.coefficients(), p, [](const auto& q) {
                               return S::Group::unstacked(q);
                             }));
}

// A system of fixed size as a RunTimeSystem.
template <DenseSystem S>
class ErasedSystem final : public AnySystem<typename S::Scalar> {
  using T = typename S::Scalar;
  using Group = typename S::Group;
  using Base = AnySystem<T>;
  using typename Base::Linear;
  using LinearSystem = typename S::template rebind<Linear>;

 public:
  using typename Base::Vector;

  explicit ErasedSystem(const S& system) : system_(system) {
    NoAudit unused;
    mass_.prepare(system_, unused);
    if constexpr (!std::is_same_v<T, Linear>)
      linear_ = std::make_unique<ErasedSystem<LinearSystem>>(system.template cast<Linear>());
  }

  Eigen::Index velocities() const override { return Group::dimension; }
  Eigen::Index multipliers() const override { return S::constraints; }

  bool commutative() const override { return Group::commutative; }
  Vector identity() const override { return stacked(Group::identity()); }
  Vector compose(const Vector& p, const Vector& q) const override {
    return stacked(Group::compose(element(p), element(q)));
  }
  Vector inverse(const Vector& q) const override { return stacked(Group::inverse(element(q))); }
  Vector exp(const Vector& v) const override { return stacked(Group::exp(v)); }
  Vector log(const Vector& q) const override { return Group::log(element(q)); }
  Vector commutator(const Vector& v, const Vector& w) const override { return Group::commutator(v, w); }
  BlockDiagonal<T> ad(const Vector& v) const override { return BlockDiagonal<T>({Group::ad(v)}); }
  BlockDiagonal<T> tangent(const Vector& v) const override { return BlockDiagonal<T>({Group::tangent(v)}); }
  BlockDiagonal<T> tangent_inverse(const Vector& v) const override {
    return BlockDiagonal<T>({Group::tangent_inverse(v)});
  }
  Vector tangent_times(const Vector& v, const Vector& w) const override { return Group::tangent_times(v, w); }
  Vector tangent_inverse_times(const Vector& v, const Vector& w) const override {
    return Group::tangent_inverse_times(v, w);
  }
  Vector coadjoint(const Vector& v, const Vector& w) const override { return Group::coadjoint(v, w); }
  Vector tangent_inverse_transposed_change(const Vector& v, const Vector& w) const override {
    return Group::tangent_inverse_transposed_change(v, w);
  }
  Vector adjoint_transposed_change(const Vector& v, const Vector& w) const override {
    return Group::adjoint_transposed_change(v, w);
  }
  T rotation_angle(const Vector& v) const override { return Group::rotation_angle(v); }

  Vector momentum(const Vector& q, const Vector& w) const override { return system_.momentum(element(q), w); }
  Vector force(const T& t, const Vector& q, const Vector& v) const override {
    return system_.force(t, element(q), v);
  }
  T energy(const Vector& q, const Vector& v) const override { return system_.energy(element(q), v); }
  T angular_momentum(const Vector& q, const Vector& v) const override {
    return system_.angular_momentum(element(q), v);
  }
  Vector initial_configuration() const override { return stacked(system_.initial_configuration()); }
  Vector initial_velocity() const override { return system_.initial_velocity(); }

  Vector constraint(const T& t, const Vector& q) const override {
    if constexpr (S::constraints == 0)
      return {};
    else
      return constraint_at(system_, t, element(q));
  }
  Vector constraint_force(const Vector& q, const Vector& lambda) const override {
    if constexpr (S::constraints == 0)
      return Vector::Constant(Group::dimension, T(0.0));
    else
      return system_.constraint_force(element(q), lambda);
  }
  Vector constraint_product(const Vector& q, const Vector& w) const override {
    if constexpr (S::constraints == 0)
      return {};
    else
      return liebench::constraint_product(system_, element(q), Velocity<S>(w));
  }
  Vector constraint_rate(const T& t, const Vector& q, const Vector& v) const override {
    if constexpr (S::constraints == 0)
      return {};
    else
      return liebench::constraint_rate(system_, t, element(q), Velocity<S>(v));
  }
  Vector constraint_curvature(const T& t, const Vector& q, const Vector& v) const override {
    if constexpr (S::constraints == 0)
      return {};
    else
      return constraint_curvature_at(system_, t, element(q), Velocity<S>(v));
  }
  bool saddle_point(const Vector& q, const Vector& a, const Vector& b, Vector& x, Vector& y,
                    KernelAudit& audit) const override {
    if constexpr (S::constraints == 0) {
      const auto solution = solve_mass_matrix(system_, element(q), Velocity<S>(a), audit);
      if (solution) x = *solution;
      return solution.has_value();
    } else {
      const auto solution = solve_saddle_point(system_, element(q), Velocity<S>(a), Multipliers<S>(b), audit);
      if (!solution) return false;
      x = solution->x;
      y = solution->y;
      return true;
    }
  }

  bool constant_mass() const override { return S::constant_mass; }
  bool mass_solve(const Vector& q, const Vector& a, Vector& x, KernelAudit& audit) const override {
    MassSolver<S> mass = mass_;
    Velocity<S> solution;
    if (!mass.solve(system_, element(q), a, solution, audit)) return false;
    x = solution;
    return true;
  }
  std::unique_ptr<AnyStageSolver<T>> stage_solver() const override {
    if constexpr (S::constraints == 0)
      return nullptr;
    else
      return std::make_unique<ErasedStageSolver<S>>(system_, StageSolver<S>(system_));
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
        return std::make_unique<ErasedStepMatrix<S, DenseStepMatrix<S, f>>>(system_);
      });
  }
  std::unique_ptr<AnyStepMatrix<T>> radau_matrix(Form form) const override {
    if constexpr (!std::is_same_v<T, Linear>)
      return nullptr;  // asked of linear() only
    else
      return with_form<S>(form, [&]<Form f>(FormConstant<f>) -> std::unique_ptr<AnyStepMatrix<T>> {
        return std::make_unique<ErasedStepMatrix<S, DenseRadauMatrix<S, f>>>(system_);
      });
  }

 private:
  static Vector stacked(const typename Group::Element& q) { return Group::stacked(q); }
  static typename Group::Element element(const Vector& q) { return Group::unstacked(q); }

  S system_;
  MassSolver<S> mass_;
  std::unique_ptr<ErasedSystem<LinearSystem>> linear_;
};

}  // namespace liebench
