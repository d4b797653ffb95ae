#include "benchmarks/floors/gauss.h"
#include "benchmarks/step.h"

namespace liebench::benchmarks {

void add_gauss() {
  using S = HeavyTopSO3<double>;
  add_pair<floors::Gauss<2>, S>("gauss/SO3/stages=2", Gauss::Options{2});
  add_pair<floors::Gauss<3>, S>("gauss/SO3/stages=3", Gauss::Options{3});
  add_pair<floors::Gauss<4>, S>("gauss/SO3/stages=4", Gauss::Options{4});
  add_pair<floors::Gauss<6>, S>("gauss/SO3/stages=6", Gauss::Options{6});
}

}  // namespace liebench::benchmarks
