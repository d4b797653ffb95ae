// The own method and BLieDF2nd on the heavy top of liebench, by its reference solution and its order fit. All methods of liebench
// on the heavy top are compiled in liebench::harness. Fails where an observed order is not the expected one.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "explicit_newmark.h"
#include "harness/instances/heavy_top_steppers.h"
#include "harness/order_fit.h"
#include "harness/references/heavy_top_reference.h"
#include "integrators/bliedf2nd.h"
#include "problems/heavy_top.h"
#include "run.h"

namespace {

using Top = liebench::HeavyTopSO3<double>;
constexpr double t_end = 0.25;

bool observe_order(const char* name, int expected, const liebench::HeavyTopReference& reference,
                   const auto& solve) {
  const auto exact = reference.at(t_end).R.cast<double>().eval();
  std::vector<liebench::ErrorPoint> errors;
  for (std::uint64_t steps = 500; steps <= 16000; steps *= 2)
    errors.push_back({.step_size = t_end / double(steps),
                      .error = Top::Group::separation(solve(steps)->configuration(), exact).norm()});
  const liebench::OrderFit fit = fit_order(errors);
  if (!fit.estimate) {
    std::printf("%s on the heavy top: no order, %s\n", name, fit.reason.c_str());
    return false;
  }
  std::printf("%s on the heavy top: order %.2f +- %.2f\n", name, fit.estimate->order,
              fit.estimate->uncertainty);
  return std::abs(fit.estimate->order - expected) < 0.1;
}

}  // namespace

int main() {
  using liebench::BLieDF2nd;
  const liebench::HeavyTopParameters parameters;  // those of the paper
  const liebench::HeavyTopReference reference(parameters, t_end);
  const Top top(parameters);
  const bool own = observe_order("explicit Newmark", 2, reference, [&](std::uint64_t steps) {
    return run<ExplicitNewmark>({}, top, t_end, steps);
  });
  const bool theirs = observe_order("BLieDF2nd, k = 3", 3, reference, [&](std::uint64_t steps) {
    auto stepper = any_stepper(liebench::MethodOptions(BLieDF2nd::Options{.k = 3}), top);
    run(*stepper, t_end / double(steps), steps);
    return stepper;
  });
  return own && theirs ? 0 : 1;
}
