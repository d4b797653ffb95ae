#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "harness/errors.h"
#include "harness/heavy_top_runs.h"
#include "harness/outside/outside_methods.h"
#include "harness/problem_checks.h"
#include "harness/problems.h"
#include "problems/heavy_top.h"

namespace liebench {

namespace {

// Beyond these a reference solution loses its digits or its patience, and no top is there.
constexpr double largest_value = 1e6;
constexpr double smallest_value = 1e-6;
// The reference turns through so many radians a second of computing time, about: 250.
constexpr double most_radians = 5e4;

std::array<double, 3> vector3(const JsonView& view) {
  constexpr std::string_view allowed = "a list of 3 finite numbers";
  if (!view.is_array() || view.size() != 3) view.reject(allowed);
  return {view[0].number("a finite number"), view[1].number("a finite number"),
          view[2].number("a finite number")};
}

std::array<double, 4> quaternion(const JsonView& view) {
  constexpr std::string_view allowed = "a list of 4 finite numbers w, x, y, z that are not all zero";
  if (!view.is_array() || view.size() != 4) view.reject(allowed);
  std::array<double, 4> q{};
  double squared = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = view[i].number("a finite number");
    squared += q[i] * q[i];
  }
  if (!(squared > 0.0)) view.reject(allowed);
  return q;
}

// Principal moments or a full matrix; symmetric positive definite.
HeavyTopParameters::Matrix inertia(const JsonView& view) {
  constexpr std::string_view allowed =
      "3 positive principal moments, or a symmetric positive definite 3 x 3 matrix as a list of rows";
  if (!view.is_array() || view.size() != 3) view.reject(allowed);
  HeavyTopParameters::Matrix J{};
  if (view[0].is_array()) {
    for (std::size_t i = 0; i < 3; ++i) J[i] = vector3(view[i]);
  } else {
    const std::array<double, 3> principal = vector3(view);
    for (std::size_t i = 0; i < 3; ++i) J[i][i] = principal[i];
  }
  Eigen::Matrix3d m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) m(Eigen::Index(i), Eigen::Index(j)) = J[i][j];
  if (m != m.transpose() || Eigen::LLT<Eigen::Matrix3d>(m).info() != Eigen::Success) view.reject(allowed);
  return J;
}

double positive(const JsonView& view) {
  const std::string allowed = fmt::format("a positive number from {} to {}", smallest_value, largest_value);
  const double x = view.number(allowed);
  if (!(x >= smallest_value && x <= largest_value)) view.reject(allowed);
  return x;
}

HeavyTopParameters from_json(const JsonView& view) {
  HeavyTopParameters p;
  if (view.has("mass")) p.mass = positive(view["mass"]);
  if (view.has("inertia")) p.inertia = inertia(view["inertia"]);
  if (view.has("center_of_mass")) p.center_of_mass = vector3(view["center_of_mass"]);
  if (view.has("gravity")) p.gravity = vector3(view["gravity"]);
  if (view.has("orientation")) p.orientation = quaternion(view["orientation"]);
  if (view.has("angular_velocity")) p.angular_velocity = vector3(view["angular_velocity"]);
  return p;
}

Json to_json(const HeavyTopParameters& p) {
  Json j;
  j["mass"] = p.mass;
  j["inertia"] = p.inertia;
  j["center_of_mass"] = p.center_of_mass;
  j["gravity"] = p.gravity;
  j["orientation"] = p.orientation;
  j["angular_velocity"] = p.angular_velocity;
  return j;
}

// The largest rate of the motion, rad/s: the spin, and the swing under gravity.
double fastest_rate(const HeavyTopParameters& p) {
  const HeavyTopData<double> data(p);
  const double smallest_moment =
      data.inertia_about_tip().selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
  return data.omega0.norm() +
         std::sqrt(data.mass * data.center_of_mass.norm() * data.gravity.norm() / smallest_moment);
}

std::string obstacle(const Json& parameters, double duration) {
  const double rate = fastest_rate(from_json({parameters, ""}));
  if (rate * duration <= most_radians) return {};
  return fmt::format(
      "a reference solution over {:.3g} s of this motion would take too long; allowed: up to {:.3g} s",
      duration, most_radians / rate);
}

struct Formulation {
  FormulationInfo info;
  RunResult (*in_double)(const RunRequest&, const HeavyTopReference&);
  RunResult (*extended)(const RunRequest&, const HeavyTopReference&);
  RunResult (*audit)(const RunRequest&, const HeavyTopReference&);
  std::unique_ptr<TimedRun> (*timed)(const RunRequest&, const HeavyTopReference&);
  SystemCheck (*check)(const HeavyTopParameters&);
};

template <template <class> class System>
Formulation formulation(std::string_view summary) {
  return {{System<double>::formulation, System<double>::constraints, summary},
          run_heavy_top<System, double>,
          run_heavy_top<System, Extended>,
          audit_heavy_top<System>,
          timed_heavy_top<System>,
          check_heavy_top<System>};
}

// Every formulation: the explicit list.
const std::vector<Formulation>& formulations() {
  static const std::vector<Formulation> list{
      formulation<HeavyTopSO3>("rotation matrix about the tip, unconstrained, eq. (57)"),
      formulation<HeavyTopS3>("unit quaternion about the tip, unconstrained"),
      formulation<HeavyTopR3xSO3>(
          "position and rotation matrix, inertial velocity, 3 constraints at the tip, eq. (58)"),
      formulation<HeavyTopR3xS3>("position and unit quaternion, inertial velocity, 3 constraints"),
      formulation<HeavyTopSE3>("rigid motions with rotation matrix, body-fixed velocity, 3 constraints"),
      formulation<HeavyTopS3R3>("rigid motions with unit quaternion, body-fixed velocity, 3 constraints"),
      formulation<HeavyTopUDQ>("unit dual quaternions, body-fixed velocity, 3 constraints")};
  return list;
}

const Formulation& by_name(std::string_view name) {
  for (const Formulation& entry : formulations())
    if (entry.info.name == name) return entry;
  throw std::logic_error(fmt::format("heavy_top has no formulation \"{}\"", name));
}

std::vector<FormulationInfo> formulation_infos() {
  std::vector<FormulationInfo> infos;
  for (const Formulation& entry : formulations()) infos.push_back(entry.info);
  return infos;
}

class HeavyTop final : public PreparedProblem {
 public:
  explicit HeavyTop(HeavyTopReference reference) : reference_(std::move(reference)) {}

  RunResult run(std::string_view formulation, Precision precision, const RunRequest& request) const override {
    if (const OutsideMethod* outside = find_outside_method(request.integrator))
      return outside->runs.run(request, reference_);
    const Formulation& entry = by_name(formulation);
    if (precision == Precision::extended) return entry.extended(request, reference_);
    RunResult result = entry.in_double(request, reference_);
    const RunResult audit = entry.audit(request, reference_);
    detail::require_same_path(result, audit, formulation, request);
    result.cost = audit.cost;
    return result;
  }
  std::unique_ptr<TimedRun> timed(std::string_view formulation, const RunRequest& request) const override {
    if (const OutsideMethod* outside = find_outside_method(request.integrator))
      return outside->runs.timed(request, reference_);
    return by_name(formulation).timed(request, reference_);
  }
  std::string reference_method() const override { return reference_.method(); }
  double reference_error() const override { return reference_.error_estimate(); }

 private:
  HeavyTopReference reference_;
};

}  // namespace

ProblemInfo heavy_top_info() {
  const Json defaults = to_json({});
  return {.name = "heavy_top",
          .summary =
              "rigid body with its tip fixed in uniform gravity (Bruels & Cardona 2010; eqs. (57) and (58))",
          .formulations = formulation_infos(),
          .parameters = {{"mass", "kg", "positive number", defaults["mass"], "m"},
                         {"inertia", "kg m^2",
                          "3 principal moments, or a symmetric positive definite 3 x 3 matrix",
                          defaults["inertia"], "J about the centre of mass, body frame"},
                         {"center_of_mass", "m", "3 numbers", defaults["center_of_mass"],
                          "X, from the tip, body frame"},
                         {"gravity", "m/s^2", "3 numbers", defaults["gravity"], "gamma, inertial frame"},
                         {"orientation", "", "quaternion w, x, y, z (normalised)", defaults["orientation"],
                          "R(t_0), body to inertial frame"},
                         {"angular_velocity", "rad/s", "3 numbers", defaults["angular_velocity"],
                          "Omega(t_0), body frame"}},
          .complete =
              [](const JsonView& view) {
                view.require_object(
                    {"mass", "inertia", "center_of_mass", "gravity", "orientation", "angular_velocity"});
                return to_json(from_json(view));
              },
          .obstacle = obstacle,
          .prepare = [](const Json& parameters, double duration, const ReferenceCache& cache,
                        const MessageCallback& message) -> std::shared_ptr<const PreparedProblem> {
            return std::make_shared<HeavyTop>(
                HeavyTopReference::load_or_build(from_json({parameters, ""}), duration, cache, message));
          },
          .check =
              [](std::string_view formulation, const Json& parameters) {
                return by_name(formulation).check(from_json({parameters, ""}));
              }};
}

}  // namespace liebench
