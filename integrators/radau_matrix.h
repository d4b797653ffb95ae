#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "integrators/dense_lu.h"
#include "integrators/form.h"
#include "integrators/outcome.h"
#include "integrators/radau_coefficients.h"
#include "integrators/radau_equation.h"
#include "integrators/run_time_system.h"
#include "problems/system.h"

namespace liebench {

// The stages in a point that has all of them behind each other; element(q) is the element that q stands for.
template <MechanicalSystem S, class Point, class Element>
RadauStages<S> radau_stages(const RadauCoefficients<typename S::Scalar>& coefficients, const Point& p,
                            const Element& element) {
  using T = typename S::Scalar;
  RadauStages<S> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto own = [&](const auto& together) {
      const Eigen::Index size = together.size() / Eigen::Index(all.size());
      return together.segment(Eigen::Index(i) * size, size).eval();
    };
    all[i] = {.t = p.t + (coefficients.c[i] - T(1.0)) * p.h,
              .angle = own(p.step),
              .q = element(own(p.q)),
              .velocity = own(p.velocity),
              .scaled_acceleration = own(p.scaled_acceleration),
              .scaled_lambda = own(p.scaled_lambda)};
  }
  return all;
}

// The Newton matrix of the stage equations, in the scalar of the linear algebra, for small systems of fixed size. With T_i = T(Theta_i)
// and D_ij = dW_i / dz_j, unknowns (z, h Lambda, eta),
//
//   [ M_i sum_k d_ik D_kj + h C_i D_ij + h^2 a_ij K_i T_i    B_i^T    d_ij M_i B_j^T + h C_i B_i^T ]
//   [ a_ij B_i T_i                                            0        0                            ]
//   [ B_i D_ij + h a_ij Z_i T_i                               0        B_i B_i^T                    ]
//
// Simplified in one place: T(Theta) Theta = Theta, so that D_Theta(T(Theta) K) = (I - T(Theta)) / tau where K = Theta / tau. As for a
// velocity of constant direction, tau = c_i h: D_ij = [i = j] T_i + a_ij / c_i (I - T_i).
template <DenseSystem S, Form form>
class DenseRadauMatrix {
 public:
  using T = typename S::Scalar;
  using Linear = LinearScalar<T>;
  using Equation = RadauEquation<S, form>;
  using Lu = DenseLu<Linear, Equation::n>;
  using Correction = typename Lu::Vector;
  using LinearSystem = typename S::template rebind<Linear>;

  explicit DenseRadauMatrix(const S& system) : linear_system_(system.template cast<Linear>()) {}

  template <class Point>
  Outcome factorize(const S& system, const T& t, const T& h, const Configuration<S>&,
                    const typename Equation::Start&, Point& point, const typename Equation::Unknowns& z) {
    Equation::complete(system, t, z, point);
    RadauStages<LinearSystem> stages;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      const RadauStage<S>& stage = point.stage[i];
      stages[i] = {.t = to_linear(stage.t),
                   .angle = stage.angle.template cast<Linear>(),
                   .q = S::Group::template cast<Linear>(stage.q),
                   .velocity = stage.velocity.template cast<Linear>(),
                   .scaled_acceleration = stage.scaled_acceleration.template cast<Linear>(),
                   .scaled_lambda = stage.scaled_lambda.template cast<Linear>()};
    }
    return factorize_at(linear_system_, to_linear(h), stages);
  }

  Outcome factorize_at(const LinearSystem& system, const Linear& h, const RadauStages<LinearSystem>& stages) {
    typename Lu::Matrix J;
    form_at(system, h, stages, J);
    mass_scale_ = J.template topLeftCorner<Equation::m, Equation::m>().template lpNorm<Eigen::Infinity>();
    if (lu_.factorize(J)) return Outcome::ok;
    return J.allFinite() ? Outcome::singular_matrix : Outcome::non_finite;
  }

  Correction solve(const Correction& r) const { return lu_.solve(r); }

  // See DenseStepMatrix.
  static constexpr double factorization_cost() { return 6.0; }
  static constexpr double most_noise() { return 32.0; }
  const Linear& mass_scale() const { return mass_scale_; }
  const RadauCoefficients<Linear>& coefficients() const { return coefficients_; }

 private:
  using Matrix = VelocityMatrix<LinearSystem>;
  static constexpr int m = S::Group::dimension;
  static constexpr int l = S::constraints;
  static constexpr int stages_ = Equation::stages;

  [[gnu::noinline]] void form_at(const LinearSystem& system, const Linear& h,
                                 const RadauStages<LinearSystem>& stages, typename Lu::Matrix& J) const {
    using Group = typename LinearSystem::Group;
    const auto& [c, a, inverse, next_change, next_value] = coefficients_;
    std::array<Matrix, std::size_t(stages_)> tangents;
    for (std::size_t i = 0; i < tangents.size(); ++i) tangents[i] = Group::tangent(stages[i].angle);
    const auto change = [&, &a = a, &c = c](std::size_t i, std::size_t j) {
      const Linear factor = a[i][j] / c[i];
      Matrix D = factor * (identity_like(tangents[i]) - tangents[i]);
      if (i == j) D += tangents[i];
      return D;
    };
    J.setConstant(Linear(0.0));
    for (std::size_t i = 0; i < tangents.size(); ++i) {
      const RadauStage<LinearSystem>& s = stages[i];
      const int row = int(i) * m;
      Velocity<LinearSystem> acceleration = Velocity<LinearSystem>::Constant(Linear(0.0));
      if constexpr (!S::constant_mass) acceleration = s.scaled_acceleration / h;
      const Multipliers<LinearSystem> lambda = s.scaled_lambda / h;
      const Matrix M = system.mass_matrix(s.q);
      const Matrix C = h * system.damping(s.t, s.q, s.velocity);
      const Matrix stiffness =
          (h * h) * (system.stiffness(s.t, s.q, s.velocity, acceleration, lambda) * tangents[i]);
      for (std::size_t j = 0; j < tangents.size(); ++j) {
        Matrix sum = inverse[i][0] * change(0, j);
        for (std::size_t k = 1; k < tangents.size(); ++k) sum += inverse[i][k] * change(k, j);
        const Matrix block = M * sum + C * change(i, j) + a[i][j] * stiffness;
        J.template block<m, m>(row, int(j) * m) = block;
      }
      if constexpr (l != 0) {
        const ConstraintGradient<LinearSystem> B = system.constraint_gradient(s.q);
        const ConstraintGradient<LinearSystem> turned = B * tangents[i];
        const int multiplier = stages_ * m + int(i) * l;
        J.template block<m, l>(row, multiplier) = B.transpose();
        for (std::size_t j = 0; j < tangents.size(); ++j)
          J.template block<l, m>(multiplier, int(j) * m) = a[i][j] * turned;
        if constexpr (Equation::stabilized) {
          const int eta = multiplier + stages_ * l;
          const ConstraintGradient<LinearSystem> Z =
              system.constraint_gradient_derivative(s.q, s.velocity) * tangents[i];
          for (std::size_t j = 0; j < tangents.size(); ++j) {
            const ConstraintGradient<LinearSystem> rate = B * change(i, j) + (h * a[i][j]) * Z;
            J.template block<l, m>(eta, int(j) * m) = rate;
            const ConstraintGradient<LinearSystem> other = system.constraint_gradient(stages[j].q);
            Eigen::Matrix<Linear, m, l> column = inverse[i][j] * (M * other.transpose());
            if (i == j) column += C * B.transpose();
            J.template block<m, l>(row, stages_ * (m + l) + int(j) * l) = column;
          }
          J.template block<l, l>(eta, eta) = B * B.transpose();
        }
      }
    }
  }

  LinearSystem linear_system_;
  RadauCoefficients<Linear> coefficients_;
  Lu lu_;
  Linear mass_scale_ = Linear(0.0);
};

// The matrix that the stages of a system are solved with.
template <MechanicalSystem S, Form form>
struct RadauMatrixOf {
  using type = typename S::template RadauMatrix<form>;
};
template <DenseSystem S, Form form>
struct RadauMatrixOf<S, form> {
  using type = DenseRadauMatrix<S, form>;
};

}  // namespace liebench
