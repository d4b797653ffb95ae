#pragma once

#include <string>
#include <vector>

#include "harness/record_row.h"
#include "plots/figure.h"

// The whole field of methods on the heavy top and a top on mounts, solvers from outside among them: the study `field` in a picture and a page
// (docs/field.md has it in words).

namespace liebench {

// Error of q against computing time (operations, where no run was timed): without and with constraints, the fast and the slow top,
// on a soft and a stiff mount.
Figure field_figure(const std::vector<RecordRow>& records);

// For the same problems, what every method needs for some errors of q.
std::string field_report(const std::vector<RecordRow>& records);

}  // namespace liebench
