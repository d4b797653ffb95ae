#include "benchmarks/floors/explicit_methods.h"
#include "benchmarks/floors/faltinsen_adams.h"
#include "benchmarks/step.h"

namespace liebench::benchmarks {

void add_explicit_methods() {
  using S = HeavyTopSO3<double>;
  add_pair<floors::Rk4, S>("rkmk/SO3/rk4", Rkmk::Options{Rkmk::Tableau::rk4});
  add_pair<floors::MuntheKaas<dormand_prince_five>, S>("rkmk/SO3/dopri5",
                                                       Rkmk::Options{Rkmk::Tableau::dopri5});
  add_pair<floors::MuntheKaas<butcher_six>, S>("rkmk/SO3/butcher6", Rkmk::Options{Rkmk::Tableau::butcher6});
  add_pair<floors::Cf4, S>("commutator_free/SO3", CommutatorFree::Options{});
  add_pair<floors::Cg3, S>("crouch_grossman/SO3", CrouchGrossman::Options{});
  add_pair<floors::FaltinsenAdams<3>, S>("faltinsen_adams/SO3/k=3", FaltinsenAdams::Options{.k = 3});
  add_pair<floors::FaltinsenAdams<4>, S>("faltinsen_adams/SO3/k=4", FaltinsenAdams::Options{.k = 4});
}

}  // namespace liebench::benchmarks
