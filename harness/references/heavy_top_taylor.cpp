#include "harness/references/heavy_top_taylor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "harness/references/heavy_top_wide.h"

namespace liebench {

namespace {

constexpr std::size_t order = 34;
constexpr double step_tolerance = 1e-40;
// Of one omitted term; some ten of them are left of the tail.
constexpr double omitted_term = 1e-34;
// Times 2^-53 this is 2e-33, what a coefficient held as a double may cost.
constexpr double double_term = 2e-17;
constexpr std::size_t max_pieces = 1'000'000;

using Series = std::array<Wide, order + 1>;
using SeriesVector = std::array<Series, 3>;

Wide cauchy(const Series& a, const Series& b, std::size_t k) {
  Wide sum = a[0] * b[k];
  for (std::size_t i = 1; i <= k; ++i) sum += a[i] * b[k - i];
  return sum;
}

WideVector cauchy_cross(const SeriesVector& a, const SeriesVector& b, std::size_t k) {
  return {cauchy(a[1], b[2], k) - cauchy(a[2], b[1], k), cauchy(a[2], b[0], k) - cauchy(a[0], b[2], k),
          cauchy(a[0], b[1], k) - cauchy(a[1], b[0], k)};
}

struct Node {
  std::array<Wide, 4> p;
  WideVector omega;
  WideVector gamma;  // R^T gravity, body frame
};

// The Taylor coefficients of the motion about one node.
struct Expansion {
  std::array<Series, 4> p;
  SeriesVector omega;
  SeriesVector gamma;

  Expansion(const HeavyTopWideData& data, const Node& node) {
    SeriesVector momentum;  // J_fix Omega
    for (std::size_t i = 0; i < 4; ++i) p[i][0] = node.p[i];
    for (std::size_t i = 0; i < 3; ++i) {
      omega[i][0] = node.omega[i];
      gamma[i][0] = node.gamma[i];
    }
    for (std::size_t k = 0; k < order; ++k) {
      const WideVector L = multiply(data.inertia, WideVector{omega[0][k], omega[1][k], omega[2][k]});
      for (std::size_t i = 0; i < 3; ++i) momentum[i][k] = L[i];
      const Wide scale = Wide(1) / Wide(k + 1);
      const Wide half = scale / 2;
      const auto& [O1, O2, O3] = omega;
      const auto& [w, x, y, z] = p;
      const Wide dw = -(cauchy(x, O1, k) + cauchy(y, O2, k) + cauchy(z, O3, k));
      const Wide dx = cauchy(w, O1, k) + cauchy(y, O3, k) - cauchy(z, O2, k);
      const Wide dy = cauchy(w, O2, k) + cauchy(z, O1, k) - cauchy(x, O3, k);
      const Wide dz = cauchy(w, O3, k) + cauchy(x, O2, k) - cauchy(y, O1, k);
      p[0][k + 1] = half * dw;
      p[1][k + 1] = half * dx;
      p[2][k + 1] = half * dy;
      p[3][k + 1] = half * dz;
      const WideVector turn = cauchy_cross(gamma, omega, k);
      WideVector moment = cauchy_cross(momentum, omega, k);
      const WideVector weight = cross(data.first_moment, {gamma[0][k], gamma[1][k], gamma[2][k]});
      for (std::size_t i = 0; i < 3; ++i) moment[i] += weight[i];
      const WideVector acceleration = multiply(data.inertia_inverse, moment);
      for (std::size_t i = 0; i < 3; ++i) {
        gamma[i][k + 1] = scale * turn[i];
        omega[i][k + 1] = scale * acceleration[i];
      }
    }
  }

  Node at(const Wide& h) const {
    const auto horner = [&h](const Series& c) {
      Wide sum = c[order];
      for (std::size_t k = order; k-- > 0;) sum = sum * h + c[k];
      return sum;
    };
    Node node;
    for (std::size_t i = 0; i < 4; ++i) node.p[i] = horner(p[i]);
    for (std::size_t i = 0; i < 3; ++i) {
      node.omega[i] = horner(omega[i]);
      node.gamma[i] = horner(gamma[i]);
    }
    return node;
  }
};

// What the coefficients are measured against: 1 for p, |gravity| for Gamma, and for Omega its length, but at
// least the frequency of a pendulum of this body, lest a start from rest ask for steps of no length.
struct Scales {
  double omega = 1;
  double gamma = 1;

  Scales(const HeavyTopWideData& data, const Node& node) {
    gamma = norm(data.gravity);
    omega = std::max(norm(node.omega), data.pendulum_frequency());
    if (gamma == 0) gamma = 1;
    if (omega == 0) omega = 1;
  }
};

// The steps that an expansion allows: the integrator's, and how far its stored polynomial reaches.
struct Reach {
  double step = HUGE_VAL;
  double radius = HUGE_VAL;

  Reach(const Expansion& e, const Scales& scales) {
    for (std::size_t k = HeavyTopTrajectory::exact_degrees; k <= order; ++k) {
      double size = 0;
      for (const Series& c : e.p) size = std::max(size, std::abs(c[k].convert_to<double>()));
      for (const Series& c : e.omega)
        size = std::max(size, std::abs(c[k].convert_to<double>()) / scales.omega);
      const auto limit = [&](double tolerance) {
        return size > 0 ? std::pow(tolerance / size, 1.0 / static_cast<double>(k)) : HUGE_VAL;
      };
      radius = std::min(radius, limit(k > HeavyTopTrajectory::degree ? omitted_term : double_term));
      if (k + 1 < order) continue;
      for (const Series& c : e.gamma)
        size = std::max(size, std::abs(c[k].convert_to<double>()) / scales.gamma);
      step = std::min(step, limit(step_tolerance));
    }
  }
};

HeavyTopTrajectory::Piece stored(const Expansion& e, double begin, double node, double radius) {
  HeavyTopTrajectory::Piece piece;
  piece.begin = begin;
  piece.node = node;
  int exponent = 0;
  std::frexp(radius, &exponent);
  piece.inverse_width = std::ldexp(1.0, -exponent);
  for (std::size_t i = 0; i < HeavyTopTrajectory::components; ++i) {
    const Series& c = i < 4 ? e.p[i] : e.omega[i - 4];
    for (std::size_t k = 0; k <= HeavyTopTrajectory::degree; ++k) {
      const Wide scaled = ldexp(c[k], exponent * static_cast<int>(k));
      if (k < HeavyTopTrajectory::exact_degrees) {
        piece.low[k][i] = to_extended(scaled);
      } else {
        piece.high[k - HeavyTopTrajectory::exact_degrees][i] = scaled.convert_to<double>();
      }
    }
  }
  return piece;
}

}  // namespace

HeavyTopTrajectory::HeavyTopTrajectory(std::vector<Piece> pieces, double end)
    : pieces_(std::move(pieces)), end_(end) {
  begins_.reserve(pieces_.size());
  for (const Piece& piece : pieces_) begins_.push_back(piece.begin);
}

HeavyTopTrajectory::Values HeavyTopTrajectory::evaluate(const Piece& piece, const Extended& t) {
  const Extended s = mul_pwr2(t - piece.node, piece.inverse_width);
  std::array<double, components> tail = piece.high.back();
  for (std::size_t k = piece.high.size() - 1; k-- > 0;) {
    for (std::size_t i = 0; i < components; ++i) tail[i] = tail[i] * s.x[0] + piece.high[k][i];
  }
  Values values;
  for (std::size_t i = 0; i < components; ++i) values[i] = s * tail[i] + piece.low.back()[i];
  for (std::size_t k = exact_degrees - 1; k-- > 0;) {
    for (std::size_t i = 0; i < components; ++i) values[i] = values[i] * s + piece.low[k][i];
  }
  return values;
}

HeavyTopTrajectory::Values HeavyTopTrajectory::at(const Extended& t) const {
  if (!(t >= 0.0 && t <= end_)) {
    throw std::out_of_range("heavy top reference: t = " + std::to_string(t.x[0]) + " is outside [0, " +
                            std::to_string(end_) + "]");
  }
  const auto next = std::upper_bound(begins_.begin() + 1, begins_.end(), t.x[0]);
  return evaluate(pieces_[static_cast<std::size_t>(next - begins_.begin()) - 1], t);
}

double HeavyTopTrajectory::largest_jump(double omega_scale) const {
  double largest = 0;
  for (std::size_t n = 1; n < pieces_.size(); ++n) {
    const Extended t = pieces_[n].begin;
    const Values before = evaluate(pieces_[n - 1], t);
    const Values after = evaluate(pieces_[n], t);
    for (std::size_t i = 0; i < components; ++i) {
      const double jump = std::abs(to_double(after[i] - before[i]));
      largest = std::max(largest, i < 4 ? jump : jump / omega_scale);
    }
  }
  return largest;
}

HeavyTopTrajectory heavy_top_by_taylor(const HeavyTopParameters& parameters, double end) {
  if (!(end > 0 && std::isfinite(end))) {
    throw std::invalid_argument("heavy top reference: the end of the interval must be positive and finite");
  }
  const HeavyTopWideData data(parameters);
  Node node{data.orientation, data.omega,
            multiply(transposed(rotation_matrix(data.orientation)), data.gravity)};
  Expansion expansion(data, node);
  Reach reach(expansion, Scales(data, node));
  double t = 0;
  double begin = 0;
  std::vector<HeavyTopTrajectory::Piece> pieces;
  while (t + reach.radius < end) {
    if (pieces.size() == max_pieces) throw std::runtime_error("heavy top reference: too many Taylor steps");
    // 1.8: two equal radii then overlap, and a node of somewhat smaller radius is still reached.
    double step = std::min(reach.step, 1.8 * reach.radius);
    while (true) {
      const double next_t = t + step;
      if (!(next_t > t)) throw std::runtime_error("heavy top reference: the Taylor step vanished");
      const Node next = expansion.at(Wide(next_t) - t);
      const Expansion next_expansion(data, next);
      const Reach next_reach(next_expansion, Scales(data, next));
      if (reach.radius + next_reach.radius < next_t - t) {
        step *= 0.7;
        continue;
      }
      pieces.push_back(stored(expansion, begin, t, reach.radius));
      // Where the pieces meet, each is used to the same fraction of its radius; the next radius may be
      // infinite.
      const double next_radius = std::min(next_reach.radius, next_t - t);
      begin = t + (next_t - t) * (reach.radius / (reach.radius + next_radius));
      t = next_t;
      expansion = next_expansion;
      reach = next_reach;
      break;
    }
  }
  pieces.push_back(stored(expansion, begin, t, std::min(reach.radius, std::max(end, 1.0))));
  return {std::move(pieces), end};
}

}  // namespace liebench
