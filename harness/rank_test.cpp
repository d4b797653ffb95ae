#include "harness/rank_test.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace liebench {

namespace {

// P(U <= u): ways[k] counts the choices of ranks that give U = k, the Gaussian binomial coefficient of
// (n + m, n), built as the product of (1 - x^(m+i)) / (1 - x^i).
double exact_tail(std::size_t n, std::size_t m, std::size_t u) {
  std::vector<double> ways(n * m + 1, 0.0);
  ways[0] = 1.0;
  for (std::size_t i = 1; i <= n; ++i) {
    for (std::size_t k = ways.size(); k-- > m + i;) ways[k] -= ways[k - (m + i)];
    for (std::size_t k = i; k < ways.size(); ++k) ways[k] += ways[k - i];
  }
  double below = 0.0, all = 0.0;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    all += ways[k];
    if (k <= u) below += ways[k];
  }
  return below / all;
}

}  // namespace

double rank_test(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || b.empty()) return 1.0;
  double u = 0.0;
  std::map<double, double> equals;
  for (const double x : a) ++equals[x];
  for (const double y : b) ++equals[y];
  for (const double x : a)
    for (const double y : b) u += x < y ? 1.0 : x == y ? 0.5 : 0.0;
  const auto n = double(a.size()), m = double(b.size()), all = n + m;
  u = std::min(u, n * m - u);
  constexpr double small = 400;
  if (equals.size() == a.size() + b.size() && n * m <= small)
    return std::min(1.0, 2.0 * exact_tail(a.size(), b.size(), std::size_t(u)));
  double ties = 0.0;
  for (const auto& [value, count] : equals) ties += count * count * count - count;
  const double variance = n * m / 12.0 * (all + 1.0 - ties / (all * (all - 1.0)));
  if (variance <= 0.0) return 1.0;
  const double z = std::max(0.0, n * m / 2.0 - u - 0.5) / std::sqrt(variance);
  return std::erfc(z / std::sqrt(2.0));
}

}  // namespace liebench
