#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "harness/strict_json.h"

// A record as tables, order fits, plots and comparisons need it: a file has 10^5 of them, and a JSON object for each takes longer than all
// that is done with it.

namespace liebench {

// JSON that does not change, shared by all that have it. Compared by value: 1 and 1.0 are equal, objects with another order of
// keys are not. Equal values have equal hashes.
class SharedJson {
 public:
  SharedJson() : SharedJson(Json::object()) {}
  explicit SharedJson(Json value);

  const Json& operator*() const { return *value_; }
  const Json* operator->() const { return value_.get(); }
  std::size_t hash() const { return hash_; }
  bool operator==(const SharedJson& other) const {
    return value_ == other.value_ || (hash_ == other.hash_ && *value_ == *other.value_);
  }

 private:
  std::shared_ptr<const Json> value_;
  std::size_t hash_;
};

// What the records of one curve share: they differ in the step size alone, or in the tolerance of a method that chooses its steps,
// which `options` therefore lacks. Strings and JSON as the record has them.
struct CurveIdentity {
  std::string problem{}, formulation{};
  SharedJson parameters{};
  std::string integrator{};
  SharedJson options{};
  std::string start{}, precision{};
  Json t_0{};
  // "t_end", or "local_steps" of runs over a number of steps, which end elsewhere for every step size; and its value.
  std::string length_key{};
  Json length{};

  // Empty for an unconstrained problem.
  std::string form() const { return options->value("form", ""); }
  bool has_option(const char* name, const Json& value) const;

  // As SharedJson.
  bool operator==(const CurveIdentity&) const = default;
  std::size_t hash() const;
};

// The keys of a record from which its identity is made.
inline constexpr std::array<std::string_view, 10> identity_keys{
    "problem", "formulation", "parameters", "integrator", "options",
    "start",   "precision",   "t_0",        "t_end",      "local_steps"};

// Reads the keys above of a record, or of an object with them alone; `parameters` and `options` only where they are not given.
CurveIdentity identity_of(const Json& record);
CurveIdentity identity_of(const Json& record, SharedJson parameters, SharedJson options);

// The numbers of a record that are kept, by their path in it; docs/records.md says what they are.
inline constexpr auto number_paths = std::to_array<std::string_view>({
    "step_size",
    "requested_step_size",
    "options/tolerance",
    "steps",
    "reference/error_estimate",
    "errors/q/end_relative",
    "errors/q/end_absolute",
    "errors/q/max_absolute",
    "errors/v/end_relative",
    "errors/v/end_absolute",
    "errors/v/max_absolute",
    "errors/lambda/end_relative",
    "errors/lambda/end_absolute",
    "errors/lambda/max_absolute",
    "agreement_time",
    "drift/energy",
    "drift/angular_momentum",
    "drift/position_constraint",
    "drift/velocity_constraint",
    "drift/group",
    "cost/residuals",
    "cost/jacobians",
    "cost/factorizations",
    "cost/factorizations_by_cause/start",
    "cost/factorizations_by_cause/first",
    "cost/factorizations_by_cause/refresh",
    "cost/factorizations_by_cause/slow_convergence",
    "cost/solves",
    "cost/rejected_steps",
    "cost/newton_iterations",
    "cost/exp",
    "cost/log",
    "cost/tangent",
    "cost/tangent_inverse",
    "cost/commutators",
    "cost/flops",
    "cost/flops_by_kind/add",
    "cost/flops_by_kind/multiply",
    "cost/flops_by_kind/divide",
    "cost/flops_by_kind/square_root",
    "cost/flops_by_kind/transcendental",
    "time/ns_per_step/median",
    "time/total_ns",
});

// One of them: its place in number_paths.
enum class RecordNumber : std::uint8_t {};

// A path that is not among them does not compile.
consteval RecordNumber record_number(std::string_view path) {
  const auto found = std::find(number_paths.begin(), number_paths.end(), path);
  if (found == number_paths.end()) throw std::invalid_argument("no such number is kept of a record");
  return RecordNumber(found - number_paths.begin());
}

struct RecordedFailure {
  double time = 0;  // s
  std::optional<std::int64_t> step{};
  std::optional<double> residual{};
  std::string message{};
};

struct RecordRow {
  std::string key{};
  std::shared_ptr<const CurveIdentity> curve{};  // never null in a row that was read
  std::string outcome{};
  std::shared_ptr<const RecordedFailure> failure{};  // null where the record has none

  // JSON has no NaN: it stands for what a record lacks.
  std::array<double, number_paths.size()> numbers;
  std::vector<double> time_samples{};  // time.ns_per_step.samples

  RecordRow() { numbers.fill(std::numeric_limits<double>::quiet_NaN()); }
  bool ended_well() const { return outcome == "ok"; }
  std::optional<double> operator[](RecordNumber number) const {
    const double value = numbers[std::size_t(number)];
    return std::isnan(value) ? std::nullopt : std::optional(value);
  }
  // Every record has these.
  double step_size() const { return numbers[std::size_t(record_number("step_size"))]; }
  double steps() const { return numbers[std::size_t(record_number("steps"))]; }
};

}  // namespace liebench
