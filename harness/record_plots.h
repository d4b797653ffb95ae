#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/select.h"
#include "plots/figure.h"

// From records to pictures: what `liebench plot` draws. Words for users in docs/plots.md.

namespace liebench {

// What a record has that can stand on an abscissa, by its name on the command line.
struct Abscissa {
  std::string_view name;
  std::string_view label;
  RecordNumber number;
  double factor;  // from the record's unit to the label's
};

// Every abscissa: step_size, time, steps and all counts.
const std::vector<Abscissa>& abscissae();

// Throws InputError with the nearest name where there is none of this name.
const Abscissa& abscissa(const std::string& name);

// The value of a record; empty where it has none. A positive one: axes are logarithmic.
std::optional<double> value_of(const RecordRow& record, const Abscissa& x);

// The first of time, flops and residuals that every run in double which ended well has; residuals where there is none.
const Abscissa& dearest_abscissa(const std::vector<RecordRow>& records);

struct RecordFigure {
  Figure figure;
  std::size_t left_out = 0;  // records without a value on the abscissa
};

// Error against the abscissa, a panel for each formulation and form (where there are several and `panels` is true), a
// colour for each method, a mark for each k. Failed runs are crosses at the upper edge; one that has no value on the abscissa
// stands where the coarsest run of its curve that ended well does.
RecordFigure error_figure(const std::vector<RecordRow>& records, const Abscissa& x, const Quantity& quantity,
                          bool panels);

// A panel for each invariant that records have, against the step size.
RecordFigure drift_figure(const std::vector<RecordRow>& records);

// "failed run: 3 newton_diverged, 1 rotation_too_large"
std::string failures_text(const std::vector<RecordRow>& records);

}  // namespace liebench
