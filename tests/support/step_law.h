#pragma once

#include <cstddef>
#include <vector>

#include "integrators/bdf_coefficients.h"
#include "integrators/form.h"
#include "problems/system.h"

namespace liebench {

// The equations of a k-step BDF method on a Lie group from the states alone: q_j, v_j, lambda_j in, defects out. A
// method's own bookkeeping (differences, histories) does not enter. Index 0 is t_{n+1}, 1 is t_n, ...
template <MechanicalSystem S>
class BdfStepLaw {
 public:
  using T = typename S::Scalar;
  using Group = typename S::Group;

  BdfStepLaw(int k, const S& system, const T& h) : k_(k), system_(system), h_(h) {
    const auto c = bdf_coefficients<T>(k);
    alpha_.assign(c.alpha.begin(), c.alpha.end());
    gamma_.assign(c.gamma.begin(), c.gamma.end());
  }

  void push(const Configuration<S>& q, const Velocity<S>& v) {
    q_.insert(q_.begin(), q);
    v_.insert(v_.begin(), v);
    // No method looks back further than k + 1 points.
    if (q_.size() > std::size_t(k_) + 2) {
      q_.pop_back();
      v_.pop_back();
    }
  }

  int k() const { return k_; }
  const T& h() const { return h_; }
  const T& alpha(int i) const { return alpha_[std::size_t(i)]; }
  const T& gamma(int i) const { return gamma_[std::size_t(i - 1)]; }
  const Configuration<S>& q(int i) const { return q_[std::size_t(i)]; }
  const Velocity<S>& v(int i) const { return v_[std::size_t(i)]; }

  // Dq of the step from q(i + 1) to q(i)
  Velocity<S> increment(int i) const {
    return Group::log(Group::compose(Group::inverse(q(i + 1)), q(i))) / h_;
  }

  // M sum alpha_i v_{n+1-i} + h (g + B^T lambda)
  Velocity<S> dynamics(const T& t, const Multipliers<S>& lambda) const {
    Velocity<S> sum = Velocity<S>::Constant(T(0.0));
    for (int i = 0; i <= k_; ++i) sum += alpha(i) * v(i);
    Velocity<S> defect = system_.momentum(q(0), sum) + h_ * system_.force(t, q(0), v(0));
    if constexpr (S::constraints > 0) defect += h_ * system_.constraint_force(q(0), lambda);
    return defect;
  }

  // What of `defect` is not in the range of B(q_n)^T, where eta of the stabilized form may put it.
  Velocity<S> without_auxiliary_multiplier(const Velocity<S>& defect) const {
    Velocity<S> rest = defect;
    const ConstraintGradient<S> B = system_.constraint_gradient(q(1));
    // Gram-Schmidt on the rows of B, twice is enough.
    std::vector<Velocity<S>> basis;
    for (int row = 0; row < S::constraints; ++row) {
      Velocity<S> b = B.row(row).transpose();
      for (int pass = 0; pass < 2; ++pass)
        for (const Velocity<S>& e : basis) b -= e.dot(b) * e;
      basis.push_back(b / b.norm());
    }
    for (int pass = 0; pass < 2; ++pass)
      for (const Velocity<S>& e : basis) rest -= e.dot(rest) * e;
    return rest;
  }

 private:
  int k_;
  S system_;
  T h_;
  std::vector<T> alpha_, gamma_;
  std::vector<Configuration<S>> q_;
  std::vector<Velocity<S>> v_;
};

}  // namespace liebench
