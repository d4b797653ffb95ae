#include "benchmarks/floors/faltinsen_bdf.h"
#include "benchmarks/step.h"
#include "integrators/faltinsen_bdf.h"

namespace liebench::benchmarks {

namespace {

template <class Top, Form form = Form::index3>
void pairs(const std::string& name) {
  using System = typename Top::System;
  using Variant = FaltinsenBdf::Variant;
  using Floor = floors::FaltinsenVariant;
  add_pair<floors::FaltinsenBdf<Top, Floor::exact>, System>(
      name + "/k=3/exact", FaltinsenBdf::Options{.k = 3, .variant = Variant::exact, .form = form});
  add_pair<floors::FaltinsenBdf<Top, Floor::bch>, System>(
      name + "/k=3/bch", FaltinsenBdf::Options{.k = 3, .variant = Variant::bch, .form = form});
}

}  // namespace

void add_faltinsen_bdf() {
  pairs<floors::SO3Top>("faltinsen_bdf/SO3");
  pairs<floors::Index3Top>("faltinsen_bdf/R3xSO3/index3");
  pairs<floors::StabilizedTop, Form::stabilized_index2>("faltinsen_bdf/R3xSO3/stabilized_index2");
}

}  // namespace liebench::benchmarks
