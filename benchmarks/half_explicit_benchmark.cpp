#include "benchmarks/floors/half_explicit.h"
#include "benchmarks/step.h"
#include "integrators/half_explicit.h"

namespace liebench::benchmarks {

namespace {

template <const auto& tableau>
void pairs(const std::string& name, HalfExplicit::Tableau choice) {
  using S = HeavyTopR3xSO3<double>;
  add_pair<floors::HalfExplicit<tableau, false>, S>(name, HalfExplicit::Options{choice, false});
  add_pair<floors::HalfExplicit<tableau, true>, S>(name + "/projection", HalfExplicit::Options{choice, true});
}

}  // namespace

void add_half_explicit() {
  pairs<herk_three>("half_explicit/R3xSO3/herk3", HalfExplicit::Tableau::herk3);
  pairs<herk_four>("half_explicit/R3xSO3/herk4", HalfExplicit::Tableau::herk4);
  pairs<hedop_five>("half_explicit/R3xSO3/hedop5", HalfExplicit::Tableau::hedop5);
}

}  // namespace liebench::benchmarks
