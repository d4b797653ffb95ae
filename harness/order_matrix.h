#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/select.h"
#include "harness/table.h"

// Expected and measured orders of every curve of a set of records: method x formulation x form, in q, v and lambda, at the
// end and as maximum over all steps.

namespace liebench {

// Of a curve's method: "BLieDF2nd, k = 3, L_k implicit".
std::string method_name(const CurveIdentity& identity);

// The order that theory gives for the error `quantity` of a curve; docs/theory.md, "Expected orders", and, of a method that chooses its
// steps, "Errors by tolerance". Empty where it gives none.
std::optional<double> expected_order(const CurveIdentity& identity, const Quantity& quantity);

// A fit against an expectation. An expected order of 0 is met by an error that does not fall.
struct Judgement {
  bool confirmed = false;
  OrderFit fit;
};

// Confirmed when the fit lies within this of the expected order, or within twice its uncertainty where that is larger, but
// never further than widest_order_tolerance.
inline constexpr double order_tolerance = 0.1;
inline constexpr double widest_order_tolerance = 0.2;

Judgement judge(const Curve& curve, const Quantity& quantity, double expected);

struct OrderMatrix {
  std::string markdown;   // a table for each formulation
  std::vector<Row> rows;  // of order_matrix_columns()
  int entries = 0;        // of which theory gives an order
  int confirmed = 0;
};

// Columns of the whole: one row for each curve and error.
std::vector<Column> order_matrix_columns();

OrderMatrix order_matrix(const std::vector<RecordRow>& records);

}  // namespace liebench
