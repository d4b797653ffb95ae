#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace liebench {

// Step size and order of a BDF method with error estimates for its order k and those beside it, each in units of the
// tolerance, as LSODE has them [Hairer, Norsett & Wanner, Solving ODE I, III.7]. The factor for the step size that an
// order allows is (bias error)^{-1 / (order + 1)}, and the order with the largest one is taken.
//
// A step that is accepted keeps step size and order until k + 1 of them are alike, and changes them only if 1.2 times
// the step is to be had; it grows by 2 at most. So the formulas stay zero-stable: errors of the past shrink by 0.16
// (k = 3) or 0.30 (k = 4) from one doubling to the next, while a doubling in every step would let them grow
// (tests/integrators/step_differences_test.cpp).
class OrderControl {
 public:
  // Of the orders k - 1, k, k + 1; infinite where there is none.
  struct Errors {
    double lower = std::numeric_limits<double>::infinity();
    double same = lower;
    double higher = lower;
  };
  static constexpr double worthwhile = 1.2, most = 2.0;

  explicit OrderControl(int max_order) : max_order_(max_order) {}

  int order() const { return order_; }
  // Whether accept() may change them after this step.
  bool may_change() const { return alike_ >= order_; }

  // Of a step that is accepted: the factor for the next one, 1 for none.
  double accept(const Errors& errors) {
    rejections_ = 0;
    ++alike_;
    if (alike_ <= order_) return 1.0;
    const Wish wish = wish_for(errors);
    if (wish.factor < worthwhile) return 1.0;
    if (wish.order != order_) alike_ = 0;
    order_ = wish.order;
    return std::min(wish.factor, most);
  }
  // Whether it would take a higher order.
  bool would_raise(const Errors& errors) const {
    const Wish wish = wish_for(errors);
    return alike_ >= order_ && wish.order > order_ && wish.factor >= worthwhile;
  }

  // Of a step whose error is too large; `unstable`: by an instability of its order, which a lower one has not.
  double reject(const Errors& errors, bool unstable = false) {
    if (falls_back()) return least;
    const double lower = factor(errors.lower, 1.3, order_ - 1), same = factor(errors.same, 1.2, order_);
    const bool falls = order_ > 1 && (unstable || lower > same);
    if (falls) --order_;
    return std::clamp(falls ? lower : same, least, 0.9);
  }
  // Of a step that failed.
  double fail() {
    falls_back();
    return 0.25;
  }
  // The step size is another one.
  void step_changed() { alike_ = 0; }

 private:
  static constexpr double least = 0.2;

  // What happens again and again needs a formula with less of the past.
  bool falls_back() {
    alike_ = 0;
    if (++rejections_ < 3) return false;
    order_ = 1;
    return true;
  }
  // What is to be had after a step that is accepted: the largest factor, and its order.
  struct Wish {
    double factor;
    int order;
  };
  Wish wish_for(const Errors& errors) const {
    const double lower = factor(errors.lower, 1.3, order_ - 1), same = factor(errors.same, 1.2, order_);
    const double higher = order_ < max_order_ ? factor(errors.higher, 1.4, order_ + 1) : 0.0;
    const double best = std::max({lower, same, higher});
    return {best, same == best ? order_ : higher == best ? order_ + 1 : order_ - 1};
  }
  static double factor(double error, double bias, int order) {
    if (order < 1 || !std::isfinite(error)) return 0.0;
    return 1.0 / (bias * std::pow(std::max(error, 1e-10), 1.0 / (order + 1)));
  }

  int max_order_;
  int order_ = 1;
  int alike_ = 0;       // steps of this size and order
  int rejections_ = 0;  // in a row
};

}  // namespace liebench
