#include "harness/stability/linear_growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "harness/instances/linear_oscillator_steppers.h"
#include "harness/run_method.h"

namespace liebench {

double linear_growth(const Contestant& method, std::complex<double> z) {
  using S = LinearOscillator<double>;
  const S system(z);
  RunRequest request;
  request.integrator = std::string(method.method->name);
  request.options = method.options_for("");
  const auto stepper = any_stepper(detail::options_of(request), system);
  std::vector<SolutionPoint<S>> points(std::size_t(stepper->starting_points()));
  // Numbers without a pattern: every mode of the method is in them.
  for (std::size_t j = 0; j < points.size(); ++j) {
    const double t = double(j);
    points[j].t = t;
    points[j].q(0) = std::sin(17.0 * t * t + 1.0);
    points[j].v(0) = std::cos(29.0 * t * t + 2.0);
    points[j].acceleration = -system.force(t, points[j].q, points[j].v);
  }
  if (stepper->start(1.0, points).outcome != Outcome::ok) return std::numeric_limits<double>::quiet_NaN();
  // The largest of so many states, so that an oscillation does not hide its size.
  constexpr int window = 16, blocks = 16;
  std::array<double, blocks> sizes{};
  const double frequency = std::max(1.0, std::abs(z));
  int blocks_done = 0;
  const auto whole_block = [&](double& largest) {
    for (int n = 0; n < window; ++n) {
      if (stepper->step().outcome != Outcome::ok) return false;
      largest = std::max(
          {largest, std::abs(stepper->configuration()(0)), std::abs(stepper->velocity()(0)) / frequency});
    }
    return true;
  };
  // Down to what rounding leaves of the first states, and far enough from the upper end of double.
  while (blocks_done < blocks && whole_block(sizes[std::size_t(blocks_done)])) {
    const double size = sizes[std::size_t(blocks_done++)];
    if (!(size > 1e-12 * sizes[0] && size < 1e120)) break;
  }
  if (blocks_done == 0) return std::numeric_limits<double>::quiet_NaN();
  const int last = blocks_done - 1;
  // Over the second half: what dies out has died out.
  const int first = last / 2;
  if (last == first) return sizes[std::size_t(last)] < 1.0 ? -1.0 : 1.0;
  return std::log10(sizes[std::size_t(last)] / sizes[std::size_t(first)]) / double(window * (last - first));
}

RegionMap stability_regions(int jobs) {
  RegionMap map;
  map.title = "Where the methods are stable, measured by their own steps";
  map.x_label = "Re(h {/Symbol m})";
  map.y_label = "Im(h {/Symbol m})";
  map.columns = 5;
  // 0.5 % of the radius: what remains of transients over so few steps.
  map.tolerance = 2e-3;
  std::vector<Contestant> methods;
  for (const int k : {1, 2, 3, 4, 5, 6}) methods.push_back(contestant("bliedf2nd", {{"k", k}}));
  for (const double rho : {1.0, 0.9, 0.5, 0.0})
    methods.push_back(contestant("generalized_alpha", {{"rho_inf", rho}}));
  // Beside what has died out rounding is large.
  for (Contestant& method : methods) method.safeguard = true;
  constexpr int nodes = 121;
  for (const Contestant& method : methods)
    map.regions.push_back({.title = plain_text(method.name),
                           .x_from = -8.0,
                           .x_to = 16.0,
                           .y_from = -12.0,
                           .y_to = 12.0,
                           .nx = nodes,
                           .ny = nodes,
                           .growth = std::vector<double>(std::size_t(nodes * nodes))});
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    const std::size_t rows = map.regions.size() * nodes;
    for (std::size_t i = next++; i < rows; i = next++) {
      RegionMap::Region& region = map.regions[i / nodes];
      const auto j = int(i % nodes);
      const double y = region.y_from + (region.y_to - region.y_from) * j / (nodes - 1);
      for (int x = 0; x < nodes; ++x) {
        const double re = region.x_from + (region.x_to - region.x_from) * x / (nodes - 1);
        region.growth[std::size_t(j * nodes + x)] = linear_growth(methods[i / nodes], {re, y});
      }
    }
  };
  std::vector<std::jthread> threads;
  for (int i = 1; i < jobs; ++i) threads.emplace_back(work);
  work();
  return map;
}

}  // namespace liebench
