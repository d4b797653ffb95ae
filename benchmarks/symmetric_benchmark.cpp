#include "benchmarks/floors/symmetric_methods.h"
#include "benchmarks/step.h"

namespace liebench::benchmarks {

void add_symmetric_methods() {
  using S = HeavyTopSO3<double>;
  add_pair<floors::Newmark, S>("newmark/SO3", Newmark::Options{});
  add_pair<floors::ImplicitMidpoint, S>("implicit_midpoint/SO3", ImplicitMidpoint::Options{});
}

}  // namespace liebench::benchmarks
