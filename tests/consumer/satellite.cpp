// The own method and BLieDF2nd on the own problem: headers only. Fails where an observed order is not the expected one.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "explicit_newmark.h"
#include "integrators/bliedf2nd.h"
#include "integrators/rkmk.h"
#include "magnetic_satellite.h"
#include "run.h"

namespace {

using Satellite = MagneticSatellite<double>;
constexpr double t_end = 60.0;

bool observe_order(const char* name, int expected, const auto& exact, const auto& solve) {
  double order = 0.0, before = 0.0;
  for (const std::uint64_t steps : {400u, 800u, 1600u}) {
    const auto stepper = solve(steps);
    const double error =
        std::max(Satellite::Group::separation(stepper->configuration(), exact.configuration()).norm(),
                 (stepper->velocity() - exact.velocity()).norm());
    order = std::log2(before / error);
    before = error;
  }
  std::printf("%s on the satellite: order %.2f\n", name, order);
  // e_h / e_{h/2} = 2^p (1 + O(h)): h of the last two runs is small enough for a tenth.
  return std::abs(order - expected) < 0.1;
}

}  // namespace

int main() {
  using liebench::BLieDF2nd;
  using liebench::Rkmk;
  const Satellite satellite;
  // Order 6: its error is round-off.
  const auto exact = run<Rkmk>({.tableau = Rkmk::Tableau::butcher6}, satellite, t_end, 3200);
  const double drift = satellite.energy(exact->configuration(), exact->velocity()) -
                       satellite.energy(satellite.initial_configuration(), satellite.initial_velocity());
  const bool own = observe_order("explicit Newmark", 2, *exact, [&](std::uint64_t steps) {
    return run<ExplicitNewmark>({}, satellite, t_end, steps);
  });
  const bool theirs = observe_order("BLieDF2nd, k = 3", 3, *exact, [&](std::uint64_t steps) {
    return run<BLieDF2nd>({.k = 3}, satellite, t_end, steps);
  });
  return own && theirs && std::abs(drift) < 1e-12 ? 0 : 1;
}
