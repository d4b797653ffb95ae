#include "benchmarks/floors/centred_bdf.h"
#include "benchmarks/step.h"

namespace liebench::benchmarks {

namespace {

template <class Top, Form form = Form::index3>
void pair(const std::string& name) {
  using System = typename Top::System;
  add_pair<floors::CentredBdf<Top>, System>(name, CentredBdf::Options{.k = 3, .form = form});
}

}  // namespace

void add_centred_bdf() {
  pair<floors::SO3Top>("centred_bdf/SO3/k=3");
  pair<floors::Index3Top>("centred_bdf/R3xSO3/index3/k=3");
  pair<floors::StabilizedTop, Form::stabilized_index2>("centred_bdf/R3xSO3/stabilized_index2/k=3");
}

}  // namespace liebench::benchmarks
