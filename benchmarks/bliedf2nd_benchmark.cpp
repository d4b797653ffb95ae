#include <cmath>

#include "benchmarks/floors/bliedf2nd.h"
#include "benchmarks/step.h"
#include "integrators/bliedf2nd.h"

namespace liebench::benchmarks {

namespace {

using SO3System = HeavyTopSO3<double>;
using R3xSO3System = HeavyTopR3xSO3<double>;

// One step for other k and step sizes, without a floor.
template <int k, class S>
void step(benchmark::State& state) {
  const double h = std::pow(10.0, -double(state.range(0)));
  measure(state, *started<S>(BLieDF2nd::Options{.k = k}, h));
}

void step_sizes(benchmark::internal::Benchmark* b) {
  b->ArgName("-log10(h)")->Arg(3)->Arg(4)->Arg(6);
}

BENCHMARK(step<2, SO3System>)->Apply(step_sizes)->Name("bliedf2nd/SO3/k=2");
BENCHMARK(step<3, SO3System>)->Apply(step_sizes)->Name("bliedf2nd/SO3/k=3");
BENCHMARK(step<4, SO3System>)->Apply(step_sizes)->Name("bliedf2nd/SO3/k=4");
BENCHMARK(step<2, R3xSO3System>)->Apply(step_sizes)->Name("bliedf2nd/R3xSO3/k=2");
BENCHMARK(step<3, R3xSO3System>)->Apply(step_sizes)->Name("bliedf2nd/R3xSO3/k=3");
BENCHMARK(step<4, R3xSO3System>)->Apply(step_sizes)->Name("bliedf2nd/R3xSO3/k=4");

template <class Top, Form form = Form::index3>
void pair(const std::string& name) {
  using System = typename Top::System;
  add_pair<floors::BLieDF2nd<Top>, System>(name, BLieDF2nd::Options{.k = 3, .form = form});
}

}  // namespace

void add_bliedf2nd() {
  pair<floors::SO3Top>("bliedf2nd/SO3/k=3");
  pair<floors::Index3Top>("bliedf2nd/R3xSO3/index3/k=3");
  pair<floors::StabilizedTop, Form::stabilized_index2>("bliedf2nd/R3xSO3/stabilized_index2/k=3");
}

}  // namespace liebench::benchmarks
