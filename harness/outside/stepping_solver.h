#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "harness/outside/outside_run.h"
#include "harness/outside/scene_run.h"
#include "harness/outside/sundials.h"

namespace liebench::outside {

// The flags with which a solver ends a step, by what they say.
struct FailureFlags {
  int convergence, setup, solve;              // of the nonlinear equations; of the linear ones
  int first_of_equations, last_of_equations;  // the equations gave no finite numbers, from -8 downwards
};

// What the solvers here share: they step `Equations_`, which give `size` and initial(), and keep a pointer to them.
template <class Equations_>
class SteppingSolver {
 public:
  using Equations = Equations_;
  static constexpr int size = Equations::size;

  SteppingSolver(const SteppingSolver&) = delete;
  SteppingSolver& operator=(const SteppingSolver&) = delete;

  double time() const { return t_; }
  bool finished() const { return finished_; }
  auto y() const { return numbers_of<size>(y_.get()); }

 protected:
  SteppingSolver(const typename Equations::Data& data, double duration)
      : context_(new_context()),
        equations_(data),
        duration_(duration),
        y_(new_vector<size>(context_, equations_.initial())) {}
  ~SteppingSolver() = default;

  // The initial values, for a solver that is made ready again.
  void back_to_start() {
    y() = equations_.initial();
    t_ = 0.0;
    finished_ = false;
  }

  // One step: call(&t) is the solver's own, and gives its flag.
  template <class Call>
  StepEnd step_by(const FailureFlags& flags, const Call& call) {
    constexpr int at_the_end = 1;
    const double before = t_;
    const int flag = call(&t_);
    if (flag < 0) return {outcome_of(flag, flags), error_.text()};
    if (!y().allFinite()) return {Outcome::non_finite, "an infinity or a NaN in the state"};
    if (!(t_ > before)) return {Outcome::step_limit, "the step is shorter than the time can tell"};
    finished_ = flag == at_the_end;
    return {};
  }

  Owned<SUNContext> context_;
  Equations equations_;
  double duration_;
  Owned<N_Vector> y_;
  LastError error_;

 private:
  static Outcome outcome_of(int flag, const FailureFlags& flags) {
    if (flag == flags.convergence) return Outcome::newton_diverged;
    if (flag == flags.setup || flag == flags.solve) return Outcome::singular_matrix;
    if (flag <= flags.first_of_equations && flag >= flags.last_of_equations) return Outcome::non_finite;
    return Outcome::step_limit;
  }

  double t_ = 0.0;
  bool finished_ = false;
};

// Flag of a function that computes: a solver tries a shorter step where the numbers are not finite.
template <class Numbers>
int computed(const Numbers& numbers) {
  return numbers.allFinite() ? 0 : 1;
}

// A solver of ordinary differential equations with quaternions (quaternion_top.h, quaternion_scene.h), with the functions
// in the form in which CVODE and ARKODE call them.
template <class Equations>
class QuaternionSolver : public SteppingSolver<Equations> {
 protected:
  using SteppingSolver<Equations>::SteppingSolver;
  using SteppingSolver<Equations>::size;
  ~QuaternionSolver() = default;

  static int derivative(double t, N_Vector y, N_Vector f, void* equations) {
    auto result = numbers_of<size>(f);
    static_cast<const Equations*>(equations)->derivative(t, numbers_of<size>(y), result);
    return computed(result);
  }
  static int jacobian(double t, N_Vector y, N_Vector, SUNMatrix J, void* equations, N_Vector, N_Vector,
                      N_Vector) {
    auto result = numbers_of<size>(J);
    static_cast<const Equations*>(equations)->jacobian(t, numbers_of<size>(y), result);
    return computed(result);
  }
};

}  // namespace liebench::outside
