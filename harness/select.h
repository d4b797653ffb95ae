#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/order_fit.h"
#include "harness/record_row.h"

// From records to curves: which error against which step size, and which records belong together.

namespace liebench {

// One recorded error: component "q", "v" or "lambda", norm "end_relative", "end_absolute" or "max_absolute".
struct Quantity {
  std::string component = "q";
  std::string norm = "end_relative";
};

// "relative error of q at the end", "maximum error of lambda in N": as an axis or a column says it.
std::string describe(const Quantity& quantity);

// The error of a record; empty where the run failed or the quantity does not apply.
std::optional<double> error_of(const RecordRow& record, const Quantity& quantity);

// Records of one curve: they differ in the step size alone.
struct Curve {
  std::string label{};                              // what sets it apart from the other curves of its set
  std::shared_ptr<const CurveIdentity> identity{};  // that of its first record
  std::vector<const RecordRow*> records{};          // by falling step size
};

// All curves of the records, in the order of their first record. Labels name what differs among them.
std::vector<Curve> curves(const std::vector<RecordRow>& records);
std::vector<Curve> curves_of(const std::vector<const RecordRow*>& records);

// The observed order of a curve: fit_order on its records with the reference's error estimate.
OrderFit fit_curve(const Curve& curve, const Quantity& quantity);

}  // namespace liebench
