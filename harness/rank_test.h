#pragma once

#include <vector>

namespace liebench {

// The probability, under the hypothesis that both samples come from one distribution, of ranks at least as
// uneven as these: the two-sided test of Mann and Whitney (1947), exact for small samples without ties, else
// by the normal approximation with correction for ties and continuity. 1 where a sample is empty.
double rank_test(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace liebench
