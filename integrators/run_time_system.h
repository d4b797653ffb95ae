#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "groups/block_diagonal.h"
#include "integrators/affine_closure.h"
#include "integrators/audit.h"
#include "integrators/form.h"
#include "integrators/outcome.h"
#include "problems/system.h"

// Any mechanical system behind one type: its elements, velocities and multipliers are vectors whose sizes are known at run
// time. Where the speed of a step does not matter (runs in extended precision, audits) the steppers of all methods are compiled
// once for a scalar, and not once for each system: the same arithmetic in the same order, to the last bit and count
// (tests/integrators/run_time_system_test.cpp).

namespace liebench {

// The Newton matrix of a system at a point, in the scalar of the linear algebra; see DenseStepMatrix.
template <class T>
class AnyStepMatrix {
 public:
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  using Derivatives =
      std::variant<ClosureDerivatives<T>, ClosureDerivatives<BlockDiagonal<T>>, ClosureDerivatives<T, true>>;
  struct Point {
    T t, h;
    Vector q_n, step, q, velocity, scaled_acceleration, scaled_lambda;
  };
  virtual ~AnyStepMatrix() = default;
  virtual Outcome factorize(const Point& point, const Derivatives& derivatives) = 0;
  virtual Vector solve(const Vector& r) const = 0;
  virtual T mass_scale() const = 0;
  virtual double factorization_cost() const = 0;
  virtual double most_noise() const = 0;
  virtual std::unique_ptr<AnyStepMatrix> clone() const = 0;
};

// What solves the linear systems of half-explicit stages; see StageSolver.
template <class T>
class AnyStageSolver {
 public:
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  virtual ~AnyStageSolver() = default;
  virtual void prepare(KernelAudit& audit) = 0;
  virtual bool mass_solve(const Vector& q, const Vector& a, Vector& x, KernelAudit& audit) = 0;
  virtual void take(const Vector& next) = 0;
  virtual void shift(const Vector& q) = 0;
  virtual Vector rate(const T& t, const Vector& next, const Vector& v) const = 0;
  virtual Outcome factorize(const Vector& q, const Vector& next, KernelAudit& audit) = 0;
  virtual void solve(const Vector& q, const Vector& next, const Vector& a, const Vector& b, Vector& x,
                     Vector& y, KernelAudit& audit) const = 0;
  virtual std::unique_ptr<AnyStageSolver> clone() const = 0;
};

// What a system and its group give, see the concepts; q by its stacked representation.
template <class T>
class AnySystem {
 public:
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  using Linear = LinearScalar<T>;

  virtual ~AnySystem() = default;
  virtual Eigen::Index velocities() const = 0;
  virtual Eigen::Index multipliers() const = 0;

  virtual bool commutative() const = 0;
  virtual Vector identity() const = 0;
  virtual Vector compose(const Vector& p, const Vector& q) const = 0;
  virtual Vector inverse(const Vector& q) const = 0;
  virtual Vector exp(const Vector& v) const = 0;
  virtual Vector log(const Vector& q) const = 0;
  virtual Vector commutator(const Vector& v, const Vector& w) const = 0;
  virtual BlockDiagonal<T> ad(const Vector& v) const = 0;
  virtual BlockDiagonal<T> tangent(const Vector& v) const = 0;
  virtual BlockDiagonal<T> tangent_inverse(const Vector& v) const = 0;
  virtual Vector tangent_times(const Vector& v, const Vector& w) const = 0;
  virtual Vector tangent_inverse_times(const Vector& v, const Vector& w) const = 0;
  virtual Vector coadjoint(const Vector& v, const Vector& w) const = 0;
  virtual Vector tangent_inverse_transposed_change(const Vector& v, const Vector& w) const = 0;
  virtual Vector adjoint_transposed_change(const Vector& v, const Vector& w) const = 0;
  virtual T rotation_angle(const Vector& v) const = 0;

  virtual Vector momentum(const Vector& q, const Vector& w) const = 0;
  virtual Vector force(const T& t, const Vector& q, const Vector& v) const = 0;
  virtual T energy(const Vector& q, const Vector& v) const = 0;
  virtual T angular_momentum(const Vector& q, const Vector& v) const = 0;
  virtual Vector initial_configuration() const = 0;
  virtual Vector initial_velocity() const = 0;
  virtual Vector constraint(const T& t, const Vector& q) const = 0;
  virtual Vector constraint_force(const Vector& q, const Vector& lambda) const = 0;
  virtual Vector constraint_product(const Vector& q, const Vector& w) const = 0;
  virtual Vector constraint_rate(const T& t, const Vector& q, const Vector& v) const = 0;
  virtual Vector constraint_curvature(const T& t, const Vector& q, const Vector& v) const = 0;
  // [M B^T; B 0] [x; y] = [a; b]; false where it is singular.
  virtual bool saddle_point(const Vector& q, const Vector& a, const Vector& b, Vector& x, Vector& y,
                            KernelAudit& audit) const = 0;

  // Whether M depends on nothing, and x with M(q) x = a; see integrators/mass_solver.h.
  virtual bool constant_mass() const = 0;
  virtual bool mass_solve(const Vector& q, const Vector& a, Vector& x, KernelAudit& audit) const = 0;
  // Of a system with constraints.
  virtual std::unique_ptr<AnyStageSolver<T>> stage_solver() const = 0;

  // The system in the scalar of the linear algebra, and the Newton matrix of such a one.
  virtual const AnySystem<Linear>& linear() const = 0;
  virtual std::unique_ptr<AnyStepMatrix<T>> step_matrix(Form form) const = 0;
  // That of the stages of Radau IIA; its point has all stages, one after the other, and it takes no derivatives.
  virtual std::unique_ptr<AnyStepMatrix<T>> radau_matrix(Form form) const = 0;
};

// Its group; valid as long as the system.
template <class T>
class RunTimeGroup {
 public:
  using Scalar = T;
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  using Element = Vector;
  using Tangent = Vector;
  using TangentMatrix = BlockDiagonal<T>;
  static constexpr int dimension = run_time_size;

  explicit RunTimeGroup(const AnySystem<T>& system) : system_(&system) {}
  template <class U>
  RunTimeGroup<U> over() const {
    static_assert(std::is_same_v<U, LinearScalar<T>>);
    return RunTimeGroup<U>(system_->linear());
  }

  Eigen::Index size() const { return system_->velocities(); }
  bool commutative() const { return system_->commutative(); }
  Element identity() const { return system_->identity(); }
  Element compose(const Element& p, const Element& q) const { return system_->compose(p, q); }
  Element inverse(const Element& q) const { return system_->inverse(q); }
  Element exp(const Tangent& v) const { return system_->exp(v); }
  Tangent log(const Element& q) const { return system_->log(q); }
  Tangent commutator(const Tangent& v, const Tangent& w) const { return system_->commutator(v, w); }
  TangentMatrix ad(const Tangent& v) const { return system_->ad(v); }
  TangentMatrix tangent(const Tangent& v) const { return system_->tangent(v); }
  TangentMatrix tangent_inverse(const Tangent& v) const { return system_->tangent_inverse(v); }
  Tangent tangent_times(const Tangent& v, const Tangent& w) const { return system_->tangent_times(v, w); }
  Tangent tangent_inverse_times(const Tangent& v, const Tangent& w) const {
    return system_->tangent_inverse_times(v, w);
  }
  Tangent coadjoint(const Tangent& v, const Tangent& w) const { return system_->coadjoint(v, w); }
  Tangent tangent_inverse_transposed_change(const Tangent& v, const Tangent& w) const {
    return system_->tangent_inverse_transposed_change(v, w);
  }
  Tangent adjoint_transposed_change(const Tangent& v, const Tangent& w) const {
    return system_->adjoint_transposed_change(v, w);
  }
  Scalar rotation_angle(const Tangent& v) const { return system_->rotation_angle(v); }
  static const Element& stacked(const Element& q) { return q; }

 private:
  const AnySystem<T>* system_;
};

template <class T>
class RunTimeSystem {
 public:
  using Scalar = T;
  using Group = RunTimeGroup<T>;
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  template <class U>
  using rebind = RunTimeSystem<U>;
  static constexpr int constraints = run_time_size;

  explicit RunTimeSystem(std::shared_ptr<const AnySystem<T>> system) : system_(std::move(system)) {}

  Group group() const { return Group(*system_); }
  Eigen::Index multipliers() const { return system_->multipliers(); }
  Vector momentum(const Vector& q, const Vector& w) const { return system_->momentum(q, w); }
  Vector force(const T& t, const Vector& q, const Vector& v) const { return system_->force(t, q, v); }
  T energy(const Vector& q, const Vector& v) const { return system_->energy(q, v); }
  T angular_momentum(const Vector& q, const Vector& v) const { return system_->angular_momentum(q, v); }
  Vector initial_configuration() const { return system_->initial_configuration(); }
  Vector initial_velocity() const { return system_->initial_velocity(); }
  Vector constraint(const T& t, const Vector& q) const { return system_->constraint(t, q); }
  Vector constraint_force(const Vector& q, const Vector& lambda) const {
    return system_->constraint_force(q, lambda);
  }
  Vector constraint_product(const Vector& q, const Vector& w) const {
    return system_->constraint_product(q, w);
  }
  Vector constraint_rate(const T& t, const Vector& q, const Vector& v) const {
    return system_->constraint_rate(t, q, v);
  }
  Vector constraint_curvature(const T& t, const Vector& q, const Vector& v) const {
    return system_->constraint_curvature(t, q, v);
  }
  template <class Audit>
  bool saddle_point(const Vector& q, const Vector& a, const Vector& b, Vector& x, Vector& y,
                    Audit& audit) const {
    if constexpr (std::is_same_v<Audit, KernelAudit>) {
      return system_->saddle_point(q, a, b, x, y, audit);
    } else {
      KernelAudit unused;
      return system_->saddle_point(q, a, b, x, y, unused);
    }
  }

  bool constant_mass() const { return system_->constant_mass(); }
  bool mass_solve(const Vector& q, const Vector& a, Vector& x, KernelAudit& audit) const {
    return system_->mass_solve(q, a, x, audit);
  }
  std::unique_ptr<AnyStageSolver<T>> stage_solver() const { return system_->stage_solver(); }

  template <Form form>
  class StepMatrix;
  template <Form form>
  class RadauMatrix;

 private:
  class HeldMatrix;
  std::shared_ptr<const AnySystem<T>> system_;
};

// A Newton matrix that can be copied.
template <class T>
class RunTimeSystem<T>::HeldMatrix {
 public:
  using Linear = LinearScalar<T>;
  using Correction = Eigen::Matrix<Linear, Eigen::Dynamic, 1>;

  HeldMatrix(const HeldMatrix& other) : matrix_(other.matrix_->clone()) {}
  HeldMatrix& operator=(const HeldMatrix& other) {
    matrix_ = other.matrix_->clone();
    return *this;
  }
  HeldMatrix(HeldMatrix&&) noexcept = default;
  HeldMatrix& operator=(HeldMatrix&&) noexcept = default;
  ~HeldMatrix() = default;

  Correction solve(const Correction& r) const { return matrix_->solve(r); }
  Linear mass_scale() const { return matrix_->mass_scale(); }
  double factorization_cost() const { return matrix_->factorization_cost(); }
  double most_noise() const { return matrix_->most_noise(); }

 protected:
  explicit HeldMatrix(std::unique_ptr<AnyStepMatrix<Linear>> matrix) : matrix_(std::move(matrix)) {}
  template <class Derived>
  static Correction linear(const Eigen::MatrixBase<Derived>& v) {
    return v.template cast<Linear>();
  }

  std::unique_ptr<AnyStepMatrix<Linear>> matrix_;
};

template <class T>
template <Form form>
class RunTimeSystem<T>::StepMatrix : public RunTimeSystem<T>::HeldMatrix {
 public:
  explicit StepMatrix(const RunTimeSystem& system) : HeldMatrix(system.system_->linear().step_matrix(form)) {}

  template <class Closure, class Point, class Unknowns>
  Outcome factorize(const RunTimeSystem& system, const T& t, const T& h, const Vector& q_n,
                    const Closure& closure, const Point& point, const Unknowns& z) {
    const auto m = system.group().size();
    return this->matrix_->factorize({.t = to_linear(t),
                                     .h = to_linear(h),
                                     .q_n = this->linear(q_n),
                                     .step = this->linear(point.step),
                                     .q = this->linear(point.q),
                                     .velocity = this->linear(point.values.velocity),
                                     .scaled_acceleration = this->linear(point.values.scaled_acceleration),
                                     .scaled_lambda = this->linear(z.segment(m, system.multipliers()))},
                                    closure.linearization(point.change));
  }
};

// The stages behind each other, at t_{n+1}.
template <class T>
template <Form form>
class RunTimeSystem<T>::RadauMatrix : public RunTimeSystem<T>::HeldMatrix {
 public:
  explicit RadauMatrix(const RunTimeSystem& system)
      : HeldMatrix(system.system_->linear().radau_matrix(form)) {}

  template <class Start, class Point, class Unknowns>
  Outcome factorize(const RunTimeSystem& system, const T& t, const T& h, const Vector& q_n, const Start&,
                    const Point& point, const Unknowns& z) {
    const auto& stages = point.stage;
    const auto together = [&](auto part) {
      const Eigen::Index size = (stages[0].*part).size();
      Vector all(Eigen::Index(stages.size()) * size);
      for (std::size_t i = 0; i < stages.size(); ++i)
        all.segment(Eigen::Index(i) * size, size) = stages[i].*part;
      return this->linear(all);
    };
    using Stage = std::remove_cvref_t<decltype(stages[0])>;
    const Eigen::Index count = Eigen::Index(stages.size());
    return this->matrix_->factorize({.t = to_linear(t),
                                     .h = to_linear(h),
                                     .q_n = this->linear(q_n),
                                     .step = together(&Stage::angle),
                                     .q = together(&Stage::q),
                                     .velocity = together(&Stage::velocity),
                                     .scaled_acceleration = together(&Stage::scaled_acceleration),
                                     .scaled_lambda = this->linear(z.segment(count * system.group().size(),
                                                                             count * system.multipliers()))},
                                    {});
  }
};

}  // namespace liebench
