#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <type_traits>

#include "groups/block_diagonal.h"
#include "groups/entrywise.h"
#include "integrators/form.h"
#include "integrators/linear_solver.h"
#include "integrators/outcome.h"
#include "integrators/patterned_matrix.h"
#include "integrators/sparse_saddle_point.h"
#include "integrators/step_equation.h"
#include "integrators/step_matrix.h"
#include "problems/system.h"

// Newton matrices of systems of many bodies, put together from their blocks.

namespace liebench {

// The matrix of StepEquation for a system of many bodies, with its unknowns (d, h lambda). In the stabilized form the change
// c = d + B_n^T eta is an unknown of its own, (d, h lambda, eta, c), so that no product of blocks fills the matrix:
//
//   [ h^2 K T          B^T     0        M*      ]    M* = h M dv'/dd + h C dv/dd
//   [ B T              0       0        0       ]
//   [ h Z T            0       0        B dv/dd ]
//   [ -I               0      -B_n^T    I       ]
//
// With explicit forces (affine_closure.h) K is no part of it, and B^T that at q_n.
template <BlockSystem S, Form form>
class SparseStepMatrix {
 public:
  using T = typename S::Scalar;
  using Linear = T;
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  using Correction = typename StepEquation<S, form>::Unknowns;
  static constexpr bool stabilized = form == Form::stabilized_index2;
  static_assert(std::same_as<T, LinearScalar<T>>);

  explicit SparseStepMatrix(const S& system)
      : m_(velocity_size(system)),
        l_(multiplier_size(system)),
        matrix_(unknowns(system)),
        extended_(Vector::Constant(matrix_.size(), T(0.0))) {}

  static LinearSolver solver(const S& system) { return PatternedMatrix<T>::solver_of(unknowns(system)); }

  template <class Closure, class Point, class Unknowns>
  Outcome factorize(const S& system, const T& t, const T& h, const Configuration<S>& q_n,
                    const Closure& closure, const Point& point, const Unknowns& z) {
    const Multipliers<S> lambda = z.segment(m_, l_) / h;
    return factorize_at(system, t, h, q_n, point.step, point.q, point.values.velocity, lambda,
                        closure.linearization(point.change));
  }

  template <class Derivatives>
  Outcome factorize_at(const S& system, const T& t, const T& h, const Configuration<S>& q_n,
                       const Velocity<S>& step, const Configuration<S>& q, const Velocity<S>& v,
                       const Multipliers<S>& lambda, const Derivatives& derivatives) {
    const auto& bodies = system.model().bodies;
    const BlockDiagonal<T> tangents = system.group().tangent(step);
    matrix_.begin();
    mass_scale_ = T(0.0);
    const bool own_change = stabilized && l_ > 0;
    const Eigen::Index change = own_change ? m_ + 2 * l_ : 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(derivatives.scaled_acceleration)>, T>)
        if (bodies[i].plain()) {
          add_plain_mass(bodies[i], change, derivatives.scaled_acceleration);
          continue;
        }
      const auto inertial = times(bodies[i].mass_matrix(), derivatives.scaled_acceleration, int(i));
      take_mass(inertial.template lpNorm<Eigen::Infinity>());
      add(bodies[i].v, change + bodies[i].v, inertial);
    }
    Sink<Derivatives> sink{*this, bodies, tangents, derivatives, h, change};
    system.linearize(t, q, v, lambda, sink);
    if constexpr (Sink<Derivatives>::explicit_forces) {
      GradientSink old{*this, bodies, 0, m_, T(1.0)};
      system.gradient(q_n, old);
    }
    if (own_change) {
      GradientSink old{*this, bodies, change, m_ + l_, T(-1.0)};
      system.gradient(q_n, old);
      for (Eigen::Index i = 0; i < m_; ++i) {
        matrix_.add(change + i, i, T(-1.0));
        matrix_.add(change + i, change + i, T(1.0));
      }
    }
    if (matrix_.factorize()) return Outcome::ok;
    return matrix_.finite() ? Outcome::singular_matrix : Outcome::non_finite;
  }

  Correction solve(const Correction& r) const {
    Correction x(r.size());
    if (extended_.size() == r.size()) {
      matrix_.solve(r, x);
    } else {
      set(extended_.head(r.size()), r);
      matrix_.solve(extended_, x);
    }
    return x;
  }
  // See DenseStepMatrix; of one to a thousand bodies.
  static constexpr double factorization_cost() { return 2.5; }
  static constexpr double most_noise() { return 1e4; }
  const T& mass_scale() const { return mass_scale_; }

 private:
  static Eigen::Index unknowns(const S& system) {
    const Eigen::Index n = velocity_size(system) + multiplier_size(system);
    return stabilized && multiplier_size(system) > 0 ? 2 * n : n;
  }
  using Matrix3 = Eigen::Matrix<T, 3, 3>;
  using Bodies = std::remove_cvref_t<decltype(std::declval<S>().model().bodies)>;

  template <class Block>
  static Block times(const Block& A, const T& factor, int) {
    return factor * A;
  }
  template <class Block>
  static Block times(const Block& A, const BlockDiagonal<T>& D, int body) {
    return A * D.blocks()[std::size_t(body)];
  }
  template <class Block>
  void add(Eigen::Index row, Eigen::Index column, const Block& block) {
    matrix_.add_block(row, column, block);
  }
  void take_mass(const T& largest) {
    if (mass_scale_ < largest) mass_scale_ = largest;
  }
  // diag(m I, J) times a number: no zeros.
  template <class Body>
  void add_plain_mass(const Body& body, Eigen::Index change, const T& factor) {
    const T mass = factor * body.mass;
    for (Eigen::Index i = 0; i < 3; ++i) matrix_.add(body.v + i, change + body.v + i, mass);
    const Matrix3 inertia = factor * body.inertia;
    add(body.v + 3, change + body.v + 3, inertia);
    take_mass(mass);
    take_mass(inertia.template lpNorm<Eigen::Infinity>());
  }

  template <class Derivatives>
  struct Sink {
    static constexpr bool wants_rate_gradient = stabilized;
    static constexpr bool explicit_forces = std::is_same_v<Derivatives, ClosureDerivatives<T, true>>;
    SparseStepMatrix& to;
    const Bodies& bodies;
    const BlockDiagonal<T>& tangents;
    const Derivatives& derivatives;
    const T& h;
    Eigen::Index change;  // the first column of c

    // A T for the columns of the body j; of a plain one T = diag(I, T_rotation).
    template <class Block>
    Block times_tangent(const Block& A, int j) const {
      const auto& tangent = tangents.blocks()[std::size_t(j)];
      if (!bodies[std::size_t(j)].plain()) return A * tangent;
      Block product = A;
      product.template rightCols<3>() =
          A.template rightCols<3>().lazyProduct(tangent.template bottomRightCorner<3, 3>());
      return product;
    }
    template <class Block>
    void stiffness(int i, int j, const Block& K) {
      if constexpr (!explicit_forces)
        to.add(bodies[std::size_t(i)].v, bodies[std::size_t(j)].v, Block((h * h) * times_tangent(K, j)));
    }
    void turning_stiffness(int i, const Matrix3& K) {
      if constexpr (!explicit_forces) {
        const Eigen::Index v = bodies[std::size_t(i)].v + 3;
        const Matrix3 tangent = tangents.blocks()[std::size_t(i)].template bottomRightCorner<3, 3>();
        to.add(v, v, Matrix3((h * h) * (K * tangent)));
      }
    }
    void turning_damping(int i, const Matrix3& C) {
      const Eigen::Index v = bodies[std::size_t(i)].v;
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(derivatives.velocity)>, T>) {
        to.add(v + 3, change + v + 3, Matrix3((h * C) * derivatives.velocity));
      } else {
        const Eigen::Matrix<T, 3, 6> rows =
            derivatives.velocity.blocks()[std::size_t(i)].template bottomRows<3>();
        to.add(v + 3, change + v, Eigen::Matrix<T, 3, 6>((h * C) * rows));
      }
    }
    template <class Block>
    void damping(int i, int j, const Block& C) {
      to.add(bodies[std::size_t(i)].v, change + bodies[std::size_t(j)].v,
             times(Block(h * C), derivatives.velocity, j));
    }
    template <class Block>
    void gradient(Eigen::Index row, int j, const Block& B) {
      const Eigen::Index v = bodies[std::size_t(j)].v, m = to.m_;
      if constexpr (!explicit_forces) to.add(v, m + row, B.transpose());
      to.add(m + row, v, times_tangent(B, j));
      if constexpr (stabilized) to.add(m + to.l_ + row, change + v, times(B, derivatives.velocity, j));
    }
    template <class Block>
    void rate_gradient(Eigen::Index row, int j, const Block& Z) {
      to.add(to.m_ + to.l_ + row, bodies[std::size_t(j)].v, (h * times_tangent(Z, j)).eval());
    }
  };
  // factor B^T at one place of the matrix.
  struct GradientSink {
    SparseStepMatrix& to;
    const Bodies& bodies;
    Eigen::Index rows, columns;
    T factor;
    template <class Block>
    void gradient(Eigen::Index row, int j, const Block& B) {
      to.add(rows + bodies[std::size_t(j)].v, columns + row, (factor * B.transpose()).eval());
    }
  };

  Eigen::Index m_, l_;
  PatternedMatrix<T> matrix_;
  mutable Vector extended_;  // a right side with the rows of c, which are zero
  T mass_scale_ = T(0.0);
};

template <BlockSystem S, Form form>
struct StepMatrixOf<S, form> {
  using type = SparseStepMatrix<S, form>;
};

// What factorizes the Newton matrices of such a system, in every scalar.
template <BlockSystem S>
LinearSolver newton_solver(const S& system, Form form) {
  return with_form<S>(form, [&]<Form f>(FormConstant<f>) { return SparseStepMatrix<S, f>::solver(system); });
}

}  // namespace liebench
