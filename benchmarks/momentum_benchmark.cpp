#include "benchmarks/floors/liemid.h"
#include "benchmarks/floors/rattlie.h"
#include "benchmarks/floors/shakelie.h"
#include "benchmarks/step.h"

namespace liebench::benchmarks {

void add_momentum_methods() {
  using SO3System = HeavyTopSO3<double>;
  using R3xSO3System = HeavyTopR3xSO3<double>;
  using Variant = Liemid::Variant;
  add_pair<floors::SO3Rattlie, SO3System>("rattlie/SO3", Rattlie::Options{});
  add_pair<floors::R3xSO3Rattlie, R3xSO3System>("rattlie/R3xSO3", Rattlie::Options{});
  add_pair<floors::R3xSO3Shakelie, R3xSO3System>("shakelie/R3xSO3", Shakelie::Options{});
  add_pair<floors::SO3Liemid<1>, SO3System>("liemid/SO3/one_step", Liemid::Options{Variant::one_step});
  add_pair<floors::SO3Liemid<2>, SO3System>("liemid/SO3/half_steps", Liemid::Options{Variant::half_steps});
}

}  // namespace liebench::benchmarks
