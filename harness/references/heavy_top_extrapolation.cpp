#include "harness/references/heavy_top_extrapolation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace liebench {

namespace {

constexpr std::size_t columns = 16;
constexpr double tolerance = 1e-35;
constexpr int max_steps = 1'000'000;

// R row by row, then Omega.
using State = std::array<Wide, 12>;

struct Flow {
  const HeavyTopWideData& data;

  State operator()(const State& y) const {
    const WideMatrix R = {WideVector{y[0], y[1], y[2]}, WideVector{y[3], y[4], y[5]},
                          WideVector{y[6], y[7], y[8]}};
    const WideVector omega = {y[9], y[10], y[11]};
    WideVector gamma;
    for (std::size_t j = 0; j < 3; ++j) {
      gamma[j] = R[0][j] * data.gravity[0] + R[1][j] * data.gravity[1] + R[2][j] * data.gravity[2];
    }
    WideVector moment = cross(multiply(data.inertia, omega), omega);
    const WideVector weight = cross(data.first_moment, gamma);
    for (std::size_t i = 0; i < 3; ++i) moment[i] += weight[i];
    const WideVector acceleration = multiply(data.inertia_inverse, moment);
    State f;
    for (std::size_t i = 0; i < 3; ++i) {
      // Row i of R Omega^.
      const WideVector row = cross(R[i], omega);
      for (std::size_t j = 0; j < 3; ++j) f[3 * i + j] = row[j];
      f[9 + i] = acceleration[i];
    }
    return f;
  }
};

void add_scaled(State& y, const Wide& h, const State& f) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += h * f[i];
}

// Gragg's modified midpoint rule over H in an even number of substeps: an error expansion in even powers of H
// / n.
State midpoint(const Flow& flow, const State& y0, const State& f0, const Wide& H, std::size_t substeps) {
  const Wide h = H / substeps;
  State before = y0;
  State now = y0;
  add_scaled(now, h, f0);
  for (std::size_t n = 1; n < substeps; ++n) {
    add_scaled(before, 2 * h, flow(now));
    std::swap(before, now);
  }
  return now;
}

struct Extrapolated {
  State y;
  double error = 0;
};

// Aitken-Neville in h^2 -> 0.
Extrapolated extrapolate(const Flow& flow, const State& y0, const Wide& H, double omega_scale) {
  const State f0 = flow(y0);
  std::array<State, columns> row;  // T_{j,0}, ..., T_{j,j}
  for (std::size_t j = 0; j < columns; ++j) {
    State next = midpoint(flow, y0, f0, H, 2 * (j + 1));
    for (std::size_t k = 0; k < j; ++k) {
      const Wide ratio = Wide(j + 1) / Wide(j - k);
      const Wide factor = 1 / (ratio * ratio - 1);
      State better = next;
      for (std::size_t i = 0; i < better.size(); ++i) better[i] += (next[i] - row[k][i]) * factor;
      row[k] = next;
      next = better;
    }
    row[j] = next;
  }
  Extrapolated result{row[columns - 1], 0};
  for (std::size_t i = 0; i < result.y.size(); ++i) {
    const double difference = std::abs(Wide(row[columns - 1][i] - row[columns - 2][i]).convert_to<double>());
    result.error = std::max(result.error, i < 9 ? difference : difference / omega_scale);
  }
  return result;
}

}  // namespace

std::vector<HeavyTopWitness> heavy_top_by_extrapolation(const HeavyTopParameters& parameters,
                                                        std::span<const double> times) {
  const HeavyTopWideData data(parameters);
  const Flow flow{data};
  const WideMatrix start = rotation_matrix(data.orientation);
  State y;
  for (std::size_t i = 0; i < 9; ++i) y[i] = start[i / 3][i % 3];
  for (std::size_t i = 0; i < 3; ++i) y[9 + i] = data.omega[i];

  const double pendulum = data.pendulum_frequency();
  std::vector<HeavyTopWitness> witnesses;
  double t = 0;
  double wished = 0;
  int steps = 0;
  for (const double target : times) {
    if (!(target > t && std::isfinite(target))) {
      throw std::invalid_argument("heavy_top_by_extrapolation: the times must ascend from above 0");
    }
    while (t < target) {
      if (++steps > max_steps) throw std::runtime_error("heavy_top_by_extrapolation: too many steps");
      const double scale = std::max(norm({y[9], y[10], y[11]}), pendulum);
      const double omega_scale = scale > 0 ? scale : 1;
      if (wished == 0) wished = 1 / omega_scale;
      const double next_t = t + wished < target ? t + wished : target;
      if (!(next_t > t)) throw std::runtime_error("heavy_top_by_extrapolation: the step vanished");
      const Extrapolated step = extrapolate(flow, y, Wide(next_t) - t, omega_scale);
      const double error = std::max(step.error, 1e-60);
      const double factor = 0.9 * std::pow(tolerance / error, 1.0 / (2.0 * columns - 1.0));
      const double taken = next_t - t;
      if (step.error <= tolerance) {
        t = next_t;
        y = step.y;
        // A step cut short by its target says little about the next.
        wished = std::max(taken * std::min(factor, 4.0), taken < wished ? wished : 0.0);
      } else {
        wished = taken * std::clamp(factor, 0.1, 0.9);
      }
    }
    HeavyTopWitness witness;
    witness.t = target;
    for (std::size_t i = 0; i < 9; ++i) witness.R[i / 3][i % 3] = y[i];
    witness.omega = {y[9], y[10], y[11]};
    witnesses.push_back(witness);
  }
  return witnesses;
}

}  // namespace liebench
