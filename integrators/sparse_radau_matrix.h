#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "groups/block_diagonal.h"
#include "groups/entrywise.h"
#include "integrators/form.h"
#include "integrators/outcome.h"
#include "integrators/patterned_matrix.h"
#include "integrators/radau_coefficients.h"
#include "integrators/radau_equation.h"
#include "integrators/radau_matrix.h"
#include "integrators/sparse_step_matrix.h"
#include "problems/system.h"

namespace liebench {

// The matrix of DenseRadauMatrix for a system of many bodies. W is an unknown of its own, (z, h Lambda, eta, W), so that no product of
// blocks fills the matrix; eta and its rows in the stabilized form only:
//
//   [ h^2 a_ij K_i T_i    B_i^T    0         d_ij M_i + [i = j] h C_i ]
//   [ a_ij B_i T_i        0        0         0                        ]
//   [ h a_ij Z_i T_i      0        0         B_i                      ]
//   [ -D_ij               0        -B_i^T    I                        ]
template <BlockSystem S, Form form>
class SparseRadauMatrix {
 public:
  using T = typename S::Scalar;
  using Linear = T;
  using Equation = RadauEquation<S, form>;
  using Correction = typename Equation::Unknowns;
  static_assert(std::same_as<T, LinearScalar<T>>);

  explicit SparseRadauMatrix(const S& system)
      : m_(velocity_size(system)),
        l_(multiplier_size(system)),
        matrix_(velocity_change(0) + Equation::stages * m_),
        extended_(Vector::Constant(matrix_.size(), T(0.0))) {}

  template <class Point>
  Outcome factorize(const S& system, const T& t, const T& h, const Configuration<S>&,
                    const typename Equation::Start&, Point& point, const typename Equation::Unknowns& z) {
    Equation::complete(system, t, z, point);
    return factorize_at(system, h, point.stage);
  }

  Outcome factorize_at(const S& system, const T& h, const RadauStages<S>& stages) {
    matrix_.begin();
    mass_scale_ = T(0.0);
    for (std::size_t i = 0; i < stages.size(); ++i) add_stage(system, h, stages[i], i);
    if (matrix_.factorize()) return Outcome::ok;
    return matrix_.finite() ? Outcome::singular_matrix : Outcome::non_finite;
  }

  Correction solve(const Correction& r) const {
    Correction x(r.size());
    set(extended_.head(r.size()), r);
    matrix_.solve(extended_, x);
    return x;
  }
  // See SparseStepMatrix.
  static constexpr double factorization_cost() { return 2.5; }
  static constexpr double most_noise() { return 1e4; }
  const T& mass_scale() const { return mass_scale_; }
  const RadauCoefficients<T>& coefficients() const { return coefficients_; }

 private:
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  using Block = typename BlockDiagonal<T>::Block;
  using Matrix3 = Eigen::Matrix<T, 3, 3>;
  using Bodies = std::remove_cvref_t<decltype(std::declval<S>().model().bodies)>;

  // The first unknown of a stage; rows in the same order: balances, constraints, rates, and W_i.
  Eigen::Index velocity(std::size_t stage) const { return Eigen::Index(stage) * m_; }
  Eigen::Index lambda(std::size_t stage) const { return Equation::stages * m_ + Eigen::Index(stage) * l_; }
  Eigen::Index eta(std::size_t stage) const { return lambda(stage) + Equation::stages * l_; }
  Eigen::Index velocity_change(std::size_t stage) const {
    return Equation::stages * (m_ + (Equation::stabilized ? 2 : 1) * l_) + Eigen::Index(stage) * m_;
  }

  void add_stage(const S& system, const T& h, const RadauStage<S>& stage, std::size_t i) {
    const auto& bodies = system.model().bodies;
    const BlockDiagonal<T> tangents = system.group().tangent(stage.angle);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const auto M = bodies[b].mass_matrix();
      for (std::size_t j = 0; j < std::size_t(Equation::stages); ++j) {
        const auto inertial = (coefficients_.inverse[i][j] * M).eval();
        matrix_.add_block(velocity(i) + bodies[b].v, velocity_change(j) + bodies[b].v, inertial);
        const T largest = inertial.template lpNorm<Eigen::Infinity>();
        if (mass_scale_ < largest) mass_scale_ = largest;
        const Block& tangent = tangents.blocks()[b];
        const T factor = coefficients_.a[i][j] / coefficients_.c[i];
        Block D = factor * (tangent - identity_like(tangent));
        if (i == j) D -= tangent;
        matrix_.add_block(velocity_change(i) + bodies[b].v, velocity(j) + bodies[b].v, D);
      }
    }
    for (Eigen::Index row = velocity_change(i); row < velocity_change(i + 1); ++row)
      matrix_.add(row, row, T(1.0));
    Sink sink{*this, bodies, tangents, h, i};
    const Multipliers<S> multipliers = stage.scaled_lambda / h;
    system.linearize(stage.t, stage.q, stage.velocity, multipliers, sink);
  }

  struct Sink {
    static constexpr bool wants_rate_gradient = Equation::stabilized;
    SparseRadauMatrix& to;
    const Bodies& bodies;
    const BlockDiagonal<T>& tangents;
    const T& h;
    std::size_t i;

    Eigen::Index place(int body) const { return bodies[std::size_t(body)].v; }
    // factor a_ij A T_i in the columns of z_j of the body.
    template <class A>
    void add_turned(Eigen::Index row, int body, const T& factor, const A& block) {
      const Block turned = block.lazyProduct(tangents.blocks()[std::size_t(body)]);
      for (std::size_t j = 0; j < std::size_t(Equation::stages); ++j)
        to.matrix_.add_block(row, to.velocity(j) + place(body),
                             Block((factor * to.coefficients_.a[i][j]) * turned));
    }
    template <class A>
    void stiffness(int a, int b, const A& K) {
      add_turned(to.velocity(i) + place(a), b, T(h * h), K);
    }
    void turning_stiffness(int body, const Matrix3& K) {
      Eigen::Matrix<T, 6, 6> whole = Eigen::Matrix<T, 6, 6>::Constant(T(0.0));
      whole.template bottomRightCorner<3, 3>() = K;
      stiffness(body, body, whole);
    }
    template <class A>
    void damping(int a, int b, const A& C) {
      to.matrix_.add_block(to.velocity(i) + place(a), to.velocity_change(i) + place(b), A(h * C));
    }
    void turning_damping(int body, const Matrix3& C) {
      to.matrix_.add_block(to.velocity(i) + place(body) + 3, to.velocity_change(i) + place(body) + 3,
                           Matrix3(h * C));
    }
    template <class A>
    void gradient(Eigen::Index row, int body, const A& B) {
      const Block transposed = B.transpose();
      to.matrix_.add_block(to.velocity(i) + place(body), to.lambda(i) + row, transposed);
      add_turned(to.lambda(i) + row, body, T(1.0), B);
      if constexpr (Equation::stabilized) {
        to.matrix_.add_block(to.eta(i) + row, to.velocity_change(i) + place(body), B);
        to.matrix_.add_block(to.velocity_change(i) + place(body), to.eta(i) + row, Block(-transposed));
      }
    }
    template <class A>
    void rate_gradient(Eigen::Index row, int body, const A& Z) {
      add_turned(to.eta(i) + row, body, h, Z);
    }
  };

  Eigen::Index m_, l_;
  RadauCoefficients<T> coefficients_;
  PatternedMatrix<T> matrix_;
  mutable Vector extended_;  // a right side with the rows of W, which are zero
  T mass_scale_ = T(0.0);
};

template <BlockSystem S, Form form>
struct RadauMatrixOf<S, form> {
  using type = SparseRadauMatrix<S, form>;
};

}  // namespace liebench
