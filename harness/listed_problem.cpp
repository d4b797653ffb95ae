#include "harness/listed_problem.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace liebench {

namespace {

using ExtendedVector = RunTimeSystem<Extended>::Vector;

std::string range_text(const NumberRange& range) {
  const bool from = std::isfinite(range.least), to = std::isfinite(range.most);
  if (from && to) return fmt::format(" from {} to {}", range.least, range.most);
  if (from) return fmt::format(" of at least {}", range.least);
  return to ? fmt::format(" of at most {}", range.most) : "";
}

// "a number from 0 to 1", "a finite number"
std::string allowed_number(const NumberRange& range) {
  const std::string limits = range_text(range);
  return fmt::format("a {}number{}", limits.empty() ? "finite " : "", limits);
}

// What the parameter takes: as above, or "a list of 3 finite numbers".
std::string allowed(const ListedParameter& p) {
  if (p.single) return allowed_number(p.text.range);
  const std::string limits = range_text(p.text.range);
  return fmt::format("a list of {} {}numbers{}", p.fallback.size(), limits.empty() ? "finite " : "", limits);
}

double number(const JsonView& view, const NumberRange& range) {
  const double x = view.number(allowed_number(range));
  if (!(x >= range.least && x <= range.most)) view.reject(allowed_number(range));
  return x;
}

std::vector<double> numbers(const JsonView& view, const ListedParameter& p) {
  if (p.single) return {number(view, p.text.range)};
  if (!view.is_array() || view.size() != p.fallback.size()) view.reject(allowed(p));
  std::vector<double> list;
  for (std::size_t i = 0; i < view.size(); ++i) list.push_back(number(view[i], p.text.range));
  return list;
}

Json value_of(const ListedParameter& p, const std::vector<double>& numbers) {
  return p.single ? Json(numbers.front()) : Json(numbers);
}

ParameterNumbers from_json(const ListedSystem& system, const JsonView& view) {
  ParameterNumbers list;
  for (const ListedParameter& p : system.parameters) {
    const std::string name(p.text.name);
    list.push_back(view.has(name) ? numbers(view[name], p) : p.fallback);
  }
  return list;
}

Json to_json(const ListedSystem& system, const ParameterNumbers& list) {
  Json j = Json::object();
  for (std::size_t i = 0; i < list.size(); ++i)
    j[std::string(system.parameters[i].text.name)] = value_of(system.parameters[i], list[i]);
  return j;
}

Json complete(const ListedSystem& system, const JsonView& view) {
  std::vector<std::string> names;
  for (const ListedParameter& p : system.parameters) names.emplace_back(p.text.name);
  view.require_object(names);
  const ParameterNumbers list = from_json(system, view);
  Json all = to_json(system, list);
  if (const auto refusal = system.refusal(list)) {
    const std::string name(refusal->parameter);
    JsonView(all.at(name), view.pointer() + "/" + name).reject(refusal->allowed);
  }
  return all;
}

// What the functions of a system give where it begins and at points beside it, in extended precision and rounded to ten digits: other
// equations give another text. What is 1e-20 of the largest number of its kind is round-off, which differs from machine to machine.
std::string samples(const RunTimeSystem<Extended>& system) {
  constexpr int points = 4;
  std::string text;
  const auto take = [&](const ExtendedVector& values) {
    double largest = 0.0;
    for (const Extended& x : values) largest = std::max(largest, std::abs(to_double(x)));
    for (const Extended& x : values) {
      const double rounded = to_double(x);
      text += fmt::format("{:.9e} ", std::abs(rounded) > 1e-20 * largest ? rounded : 0.0);
    }
    text += '\n';
  };
  std::mt19937 engine{1};
  const auto beside = [&](double size) {
    ExtendedVector v(velocity_size(system));
    for (Extended& x : v) x = Extended(size * (double(engine()) / 2147483648.0 - 1.0));
    return v;
  };
  ExtendedVector q = system.initial_configuration(), v = system.initial_velocity();
  const double speed = to_double(Extended(v.norm()));
  for (int k = 0; k < points; ++k) {
    const Extended t = Extended(0.1) * double(k);
    if (k > 0) {
      q = system.group().compose(q, system.group().exp(beside(0.25)));
      v = system.initial_velocity() + beside(speed > 0.0 ? speed : 1.0);
    }
    const ExtendedVector momentum = system.momentum(q, v);
    for (const ExtendedVector& values : {q, v, momentum, system.force(t, q, v)}) take(values);
    // The energy beside what it may be the small difference of.
    ExtendedVector energy(2);
    energy << system.energy(q, v), v.dot(momentum);
    take(energy);
    if (system.multipliers() == 0) continue;
    const ExtendedVector ones = ExtendedVector::Constant(system.multipliers(), Extended(1.0));
    for (const ExtendedVector& values :
         {system.constraint(t, q), system.constraint_rate(t, q, v), system.constraint_curvature(t, q, v),
          system.constraint_force(q, ones)})
      take(values);
  }
  return text;
}

// Version of the code that integrates references, and of their layout.
constexpr std::uint32_t reference_version = 1;

class PreparedListed final : public PreparedProblem {
 public:
  PreparedListed(std::unique_ptr<ListedInstance> instance, IntegratedReference reference)
      : instance_(std::move(instance)), reference_(std::move(reference)) {}

  RunResult run(std::string_view, Precision precision, const RunRequest& request) const override {
    return instance_->run(precision, request, reference_);
  }
  std::unique_ptr<TimedRun> timed(std::string_view, const RunRequest& request) const override {
    return instance_->timed(request, reference_);
  }
  std::string reference_method() const override { return reference_.method(); }
  double reference_error() const override { return reference_.error_estimate(); }

 private:
  std::unique_ptr<ListedInstance> instance_;
  IntegratedReference reference_;
};

std::shared_ptr<const PreparedProblem> prepare(const ListedSystem& listed, const Json& parameters,
                                               double duration, const ReferenceCache& cache,
                                               const MessageCallback& message) {
  std::unique_ptr<ListedInstance> instance = listed.make(from_json(listed, {parameters, ""}));
  const RunTimeSystem<Extended> system = instance->extended();
  const ReferenceKey key{
      std::string(listed.name), reference_version,
      fmt::format("{}\nduration {}\nfingerprint {}", parameters.dump(), duration, fingerprint(system))};
  IntegratedReference::Options options;
  options.separation = [&](const ExtendedVector& q, const ExtendedVector& p) {
    return instance->separation(q, p);
  };
  std::optional<IntegratedReference> reference;
  if (const auto payload = cache.load(key, message))
    reference = IntegratedReference::restored(system, duration, *payload);
  if (!reference) {
    reference.emplace(system, duration, options);
    cache.store(key, reference->payload(), message);
  }
  return std::make_shared<PreparedListed>(std::move(instance), std::move(*reference));
}

}  // namespace

std::string fingerprint(const RunTimeSystem<Extended>& system) {
  const std::string text = samples(system);
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

ProblemInfo listed_problem(const ListedSystem& listed) {
  const ListedSystem* system = &listed;
  std::vector<ParameterInfo> parameters;
  for (const ListedParameter& p : listed.parameters)
    parameters.push_back({p.text.name, p.text.unit, allowed(p), value_of(p, p.fallback), p.text.meaning});
  return {.name = listed.name,
          .summary = listed.summary,
          .formulations = {{.name = listed.formulation,
                            .constraints = listed.constraints,
                            .summary = listed.formulation_summary}},
          .parameters = std::move(parameters),
          .complete = [system](const JsonView& view) { return complete(*system, view); },
          // Its steps are bounded.
          .obstacle = [](const Json&, double) { return std::string(); },
          .prepare =
              [system](const Json& values, double duration, const ReferenceCache& cache,
                       const MessageCallback& message) {
                return prepare(*system, values, duration, cache, message);
              },
          .check =
              [system](std::string_view, const Json& values) {
                return check_listed_system(system->name, from_json(*system, {values, ""}));
              },
          .fingerprint =
              [system](const Json& values) {
                return liebench::fingerprint(system->make(from_json(*system, {values, ""}))->extended());
              }};
}

}  // namespace liebench
