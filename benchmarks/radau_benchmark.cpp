#include "benchmarks/floors/radau.h"
#include "benchmarks/step.h"

namespace liebench::benchmarks {

void add_radau() {
  using SO3System = HeavyTopSO3<double>;
  using R3xSO3System = HeavyTopR3xSO3<double>;
  add_pair<floors::SO3Radau, SO3System>("radau/SO3", Radau::Options{});
  add_pair<floors::R3xSO3Radau<false>, R3xSO3System>("radau/R3xSO3/index3", Radau::Options{});
  add_pair<floors::R3xSO3Radau<true>, R3xSO3System>("radau/R3xSO3/stabilized_index2",
                                                    Radau::Options{.form = Form::stabilized_index2});
}

}  // namespace liebench::benchmarks
