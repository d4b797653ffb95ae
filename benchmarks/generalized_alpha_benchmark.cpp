#include "benchmarks/floors/generalized_alpha.h"
#include "benchmarks/step.h"
#include "integrators/generalized_alpha.h"

namespace liebench::benchmarks {

namespace {

template <class Top, Form form = Form::index3>
void pair(const std::string& name) {
  using System = typename Top::System;
  add_pair<floors::GeneralizedAlpha<Top>, System>(name,
                                                  GeneralizedAlpha::Options{.rho_inf = 0.9, .form = form});
}

}  // namespace

void add_generalized_alpha() {
  pair<floors::SO3Top>("generalized_alpha/SO3/rho_inf=0.9");
  pair<floors::Index3Top>("generalized_alpha/R3xSO3/index3/rho_inf=0.9");
  pair<floors::StabilizedTop, Form::stabilized_index2>(
      "generalized_alpha/R3xSO3/stabilized_index2/rho_inf=0.9");
}

}  // namespace liebench::benchmarks
