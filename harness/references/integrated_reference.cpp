#include "harness/references/integrated_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <stdexcept>

#include "integrators/self_start.h"
#include "problems/audited_system.h"

namespace liebench {

namespace {

constexpr double wanted_error = 1e-17;
constexpr std::size_t window = 10;

// Numbers one behind the other.
class PayloadWriter {
 public:
  void put(double x) {
    std::array<char, sizeof x> raw;
    std::memcpy(raw.data(), &x, sizeof x);
    bytes_.append(raw.data(), raw.size());
  }
  void put(const IntegratedReference::System::Vector& v) {
    for (const Extended& x : v) {
      put(x.x[0]);
      put(x.x[1]);
    }
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class PayloadReader {
 public:
  explicit PayloadReader(std::string_view bytes) : bytes_(bytes) {}
  double number() {
    double x = 0.0;
    std::memcpy(&x, bytes_.data(), sizeof x);
    bytes_.remove_prefix(sizeof x);
    return x;
  }
  IntegratedReference::System::Vector vector(Eigen::Index size) {
    IntegratedReference::System::Vector v(size);
    for (Extended& x : v) {
      const double high = number();
      x = Extended(high, number());
    }
    return v;
  }

 private:
  std::string_view bytes_;
};

// Before the nodes: their number, the error estimate and the agreement time.
constexpr std::size_t header_numbers = 3;

std::size_t node_numbers(const IntegratedReference::System& system) {
  const auto q = system.initial_configuration().size(), v = velocity_size(system);
  return 2 * std::size_t(q + v + multiplier_size(system));
}

}  // namespace

IntegratedReference::IntegratedReference(const System& system, double duration, const Options& options)
    : IntegratedReference(system, duration) {
  integrate(options);
}

void IntegratedReference::integrate(const Options& options) {
  const std::uint64_t most = options.most_steps;
  std::uint64_t steps = 100;
  double speed = options.speed;
  const auto distance = [&](const Node& a, const Node& b) {
    const System::Vector difference = a.v - b.v;
    const double size = speed + (options.speed > 0.0 ? to_double(Extended(b.v.norm())) : 0.0);
    const double position = options.separation(a.q, b.q);
    const double velocity = to_double(Extended(difference.norm())) / size;
    return std::isfinite(position + velocity) ? std::max(position, velocity) : INFINITY;
  };
  // An explicit method: what is stiff stops it in large steps. Those of the last round must not stop.
  const auto may_stop = [most](std::uint64_t n) { return 4 * n <= most; };
  std::vector<Node> coarse = trajectory(steps, may_stop(steps));
  while (true) {
    std::vector<Node> fine = trajectory(2 * steps, may_stop(2 * steps));
    if (options.speed == 0.0) {
      speed = 0.0;
      for (const Node& node : fine) speed = std::max(speed, to_double(Extended(node.v.norm())));
      if (speed == 0.0) speed = 1.0;
    }
    error_estimate_ = coarse.empty() || fine.empty() ? INFINITY : distance(coarse.back(), fine.back());
    if (error_estimate_ < 63.0 * wanted_error || !may_stop(steps)) {
      std::size_t agreed = 0;
      while (agreed + 1 < coarse.size() && distance(coarse[agreed + 1], fine[2 * agreed + 2]) < agreement)
        ++agreed;
      agreement_time_ = duration_ * double(agreed) / double(steps);
      if (agreed < steps && !options.chaotic)
        throw std::runtime_error(
            fmt::format("trajectories of {} and {} steps agree up to t = {:.3g} s only; choose \"t_end\" up "
                        "to that{}",
                        steps, 2 * steps, agreement_time_, options.advice));
      // Beyond that time nothing is compared.
      if (agreed < steps) error_estimate_ = distance(coarse[agreed], fine[2 * agreed]);
      // Richardson: the finer trajectory is 63 times nearer.
      error_estimate_ = std::max(error_estimate_ / 63.0, 1e-30);
      nodes_ = std::move(fine);
      spacing_ = Extended(duration_) / Extended(double(2 * steps));
      return;
    }
    coarse = std::move(fine);
    steps *= 2;
  }
}

std::vector<IntegratedReference::Node> IntegratedReference::trajectory(std::uint64_t steps,
                                                                       bool may_stop) const {
  NoAudit audit;
  const Extended h = Extended(duration_) / Extended(double(steps));
  System::Vector q = system_.initial_configuration(), v = system_.initial_velocity();
  std::vector<Node> nodes;
  for (std::uint64_t n = 0; n <= steps; ++n) {
    const Extended t = h * Extended(double(n));
    StepResult result;
    if (n > 0) result = index1_step(system_, Extended(t - h), h, q, v, audit).result;
    if (result.outcome == Outcome::ok) result = project_on_constraints(system_, t, q, v, audit);
    const auto dynamics = consistent_dynamics(system_, t, q, v, audit);
    if (result.outcome != Outcome::ok || !dynamics) {
      if (may_stop) return {};
      throw std::runtime_error(fmt::format(
          "the reference method stops at t = {:.3g} s in steps of {:.2g} s: {}; choose \"t_end\" up to that",
          to_double(t), to_double(h),
          name(result.outcome == Outcome::ok ? Outcome::singular_matrix : result.outcome)));
    }
    nodes.push_back({q, v, dynamics->lambda});
  }
  return nodes;
}

IntegratedReference::Point IntegratedReference::at(const Extended& t) const {
  const Uncounted uncounted;
  const double place = to_double(t / spacing_);
  const auto nearest = std::size_t(std::clamp(std::lround(place), 0L, long(nodes_.size()) - 1));
  const std::size_t first =
      nearest < window / 2 ? 0
                           : std::min(nearest - window / 2, nodes_.size() - std::min(nodes_.size(), window));
  const std::size_t last = std::min(nodes_.size(), first + window);
  const auto group = system_.group();
  const Node& centre = nodes_[nearest];
  const System::Vector back = group.inverse(centre.q);
  const Extended x = t / spacing_;
  System::Vector s = zero_velocity(system_), v = s, lambda = zero_multipliers(system_);
  for (std::size_t j = first; j < last; ++j) {
    Extended weight(1.0);
    for (std::size_t i = first; i < last; ++i)
      if (i != j) weight *= (x - Extended(double(i))) / Extended(double(j) - double(i));
    if (j != nearest) s += weight * group.log(group.compose(back, nodes_[j].q));
    v += weight * nodes_[j].v;
    lambda += weight * nodes_[j].lambda;
  }
  Point point{t, group.compose(centre.q, group.exp(s)), v, zero_velocity(system_), lambda};
  NoAudit audit;
  if (const auto dynamics = consistent_dynamics(system_, t, point.q, point.v, audit))
    point.acceleration = dynamics->acceleration;
  return point;
}

std::string IntegratedReference::method() const {
  return fmt::format("Runge-Kutta-Munthe-Kaas of order 6, {} steps, 106 bits", nodes_.size() - 1);
}

std::string IntegratedReference::payload() const {
  PayloadWriter writer;
  writer.put(double(nodes_.size()));
  writer.put(error_estimate_);
  writer.put(agreement_time_);
  for (const Node& node : nodes_) {
    writer.put(node.q);
    writer.put(node.v);
    writer.put(node.lambda);
  }
  return writer.bytes();
}

std::optional<IntegratedReference> IntegratedReference::restored(const System& system, double duration,
                                                                 std::string_view payload) {
  if (payload.size() < header_numbers * sizeof(double)) return std::nullopt;
  IntegratedReference reference(system, duration);
  PayloadReader reader(payload);
  const double count = reader.number();
  const std::size_t size = node_numbers(system) * sizeof(double);
  if (!(count > 1.0) || double(payload.size() - header_numbers * sizeof(double)) != count * double(size))
    return std::nullopt;
  reference.error_estimate_ = reader.number();
  reference.agreement_time_ = reader.number();
  const auto q = system.initial_configuration().size(), v = velocity_size(system),
             l = multiplier_size(system);
  for (std::size_t n = 0; n < std::size_t(count); ++n) {
    Node node;
    node.q = reader.vector(q);
    node.v = reader.vector(v);
    node.lambda = reader.vector(l);
    reference.nodes_.push_back(std::move(node));
  }
  reference.spacing_ = Extended(duration) / Extended(count - 1.0);
  return reference;
}

}  // namespace liebench
