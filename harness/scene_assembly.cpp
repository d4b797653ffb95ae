#include "harness/scene_assembly.h"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <type_traits>

#include "harness/errors.h"
#include "harness/implied_rows.h"
#include "integrators/consistent_projection.h"
#include "integrators/sparse_step_matrix.h"
#include "problems/scene_model.h"

namespace liebench {

namespace {

using System = SceneSystem<double>;

// A pose as Ceres moves it: position and unit quaternion (w, x, y, z).
struct Pose {
  std::array<double, 3> position;
  std::array<double, 4> orientation;
};

template <class U>
RigidState<U> state_of(const U* position, const U* orientation) {
  RigidState<U> s = RigidState<U>::ground();
  s.x = Eigen::Map<const Eigen::Matrix<U, 3, 1>>(position);
  const Quaternion<U> p = Eigen::Map<const Quaternion<U>>(orientation);
  s.R = rotation_matrix<U>(p);
  return s;
}

// The residual of a constraint as a function of the poses of its bodies.
template <class Constraint>
struct ConstraintResidual {
  Constraint constraint;
  bool ground_a, ground_b;

  template <class U>
  bool operator()(const U* position_a, const U* orientation_a, const U* position_b, const U* orientation_b,
                  U* residual) const {
    return evaluate(state_of(position_a, orientation_a), state_of(position_b, orientation_b), residual);
  }
  template <class U>
  bool operator()(const U* position, const U* orientation, U* residual) const {
    const RigidState<U> body = state_of(position, orientation), ground = RigidState<U>::ground();
    return ground_a ? evaluate(ground, body, residual) : evaluate(body, ground, residual);
  }

 private:
  template <class U>
  bool evaluate(const RigidState<U>& a, const RigidState<U>& b, U* residual) const {
    Eigen::Map<Eigen::Matrix<U, Constraint::rows, 1>> r(residual);
    r = constraint.template residual<U>(0.0, a, b) * U(weight);
    return true;
  }
  // Joints close, poses stay: what is left of a gap is its weight's inverse square of the change.
  static constexpr double weight = 1e4;
};

// The change of a pose, m and (imaginary part of the relative quaternion, doubled) rad.
struct Change {
  Pose given;
  template <class U>
  bool operator()(const U* position, const U* orientation, U* residual) const {
    for (std::size_t i = 0; i < 3; ++i) residual[i] = position[i] - U(given.position[i]);
    const Quaternion<U> p = Eigen::Map<const Quaternion<U>>(orientation);
    const Quaternion<U> start = Eigen::Map<const Quaternion<double>>(given.orientation.data()).cast<U>();
    const Quaternion<U> relative = quaternion_product<U>(quaternion_conjugate<U>(start), p);
    for (int i = 0; i < 3; ++i) residual[3 + i] = U(2.0) * relative(1 + i);
    return true;
  }
};

// Moves bodies of the model; those with a fixed point turn about it.
class CeresAssembly {
 public:
  CeresAssembly(const SceneDescription& scene, const SceneModel<double>& model) : scene_(scene) {
    for (const BodyDescription& body : scene.bodies) {
      Pose pose;
      Eigen::Map<Eigen::Vector3d>(pose.position.data()) = body.position;
      Eigen::Map<Eigen::Vector4d>(pose.orientation.data()) = body.orientation.normalized();
      poses_.push_back(pose);
    }
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      problem_.AddParameterBlock(poses_[i].position.data(), 3);
      problem_.AddParameterBlock(poses_[i].orientation.data(), 4, new ceres::QuaternionManifold);
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<Change, 6, 3, 4>(new Change{poses_[i]}),
                                nullptr, poses_[i].position.data(), poses_[i].orientation.data());
      if (has_fixed_point(scene.bodies[i].kind))
        add(PlacedConstraint<Coincidence<double>>{
            Coincidence<double>{model.bodies[i].fixed_point, -model.bodies[i].arm}, -1, int(i), {}});
    }
    std::apply([&](const auto&... lists) { (add_all(lists), ...); }, model.constraints);
  }

  SceneDescription solve() {
    ceres::Solver::Options options;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-16;
    options.gradient_tolerance = 1e-16;
    options.parameter_tolerance = 1e-14;
    options.linear_solver_type = poses_.size() > 30 ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::DENSE_QR;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    SceneDescription moved = scene_;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      moved.bodies[i].position = Eigen::Map<Eigen::Vector3d>(poses_[i].position.data());
      moved.bodies[i].orientation = Eigen::Map<Eigen::Vector4d>(poses_[i].orientation.data()).normalized();
    }
    return moved;
  }

 private:
  template <class List>
  void add_all(const List& list) {
    for (const auto& placed : list) add(placed);
  }
  template <class C>
  void add(const PlacedConstraint<C>& c) {
    using Residual = ConstraintResidual<C>;
    auto* residual = new Residual{c.constraint, c.a < 0, c.b < 0};
    if (c.a >= 0 && c.b >= 0) {
      Pose &a = poses_[std::size_t(c.a)], &b = poses_[std::size_t(c.b)];
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual, C::rows, 3, 4, 3, 4>(residual),
                                nullptr, a.position.data(), a.orientation.data(), b.position.data(),
                                b.orientation.data());
    } else {
      Pose& body = poses_[std::size_t(std::max(c.a, c.b))];
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual, C::rows, 3, 4>(residual), nullptr,
                                body.position.data(), body.orientation.data());
    }
  }

  const SceneDescription& scene_;
  std::vector<Pose> poses_;
  ceres::Problem problem_;
};

// Of a scene that is assembled, m or rad.
constexpr double largest_gap_allowed = 1e-8;

struct Gap {
  double size = 0.0;
  std::size_t row = 0;
};

Gap largest_gap(const System& system, const Eigen::VectorXd& q) {
  Gap gap;
  if (system.multipliers() == 0) return gap;
  Eigen::Index row = 0;
  gap.size = system.constraint(0.0, q).cwiseAbs().maxCoeff(&row);
  gap.row = std::size_t(row);
  return gap;
}

// Two rows that are the same where all joints fit differ by as much as these gape, for lengths of about 1 m; a row that is a sum of
// others, with coefficients of sum 10, by ten times that. All rows of the scenes that come with it leave less than 1e-14 or more
// than 0.01 (tests/harness/implied_rows_test.cpp).
double rank_tolerance(double gap) {
  return 10.0 * std::max(gap, AssembledScene::fits);
}

// The largest gap of all joints beside q, where only the independent ones hold: round-off where these imply the others. Where
// a mechanism begins in a singular place, more constraints look implied than are, and their joints gape here, in proportion to the
// square of the way. None where nothing can move.
Gap gap_beside(const System& system, const System& independent, const Eigen::VectorXd& q) {
  constexpr double way = 1e-2;  // m or rad, of what moves most
  NoAudit audit;
  // Of all motions that the joints allow a mixture, for the free motion of one body may be the right one by accident.
  Eigen::VectorXd mixture(velocity_size(independent));
  for (Eigen::Index i = 0; i < mixture.size(); ++i) mixture(i) = std::sin(double(i + 1));
  const auto motion = solve_saddle_point(independent, q, independent.momentum(q, mixture),
                                         zero_multipliers(independent), audit);
  if (!motion) return {};
  const double most = motion->x.lpNorm<Eigen::Infinity>();
  // The mixture has size 1; of what is not free round-off is left.
  if (!(most > 1e-6)) return {};
  Eigen::VectorXd moved = independent.group().compose(q, independent.group().exp(motion->x * (way / most)));
  Eigen::VectorXd v = zero_velocity(independent);
  if (project_on_constraints(independent, 0.0, moved, v, audit).outcome != Outcome::ok) return {};
  if (independent.multipliers() > 0 &&
      !(independent.constraint(0.0, moved).lpNorm<Eigen::Infinity>() <= largest_gap_allowed))
    return {};
  return largest_gap(system, moved);
}

}  // namespace

std::vector<RowOfJoint> rows_of_joints(const SceneDescription& scene) {
  std::vector<RowOfJoint> result;
  for (const JointDescription& joint : scene.joints) {
    // Its two bodies alone say how many rows it has.
    SceneDescription alone;
    JointDescription same = joint;
    for (int* const body : {&same.a, &same.b})
      if (*body >= 0) {
        alone.bodies.push_back(scene.bodies[std::size_t(*body)]);
        *body = int(alone.bodies.size()) - 1;
      }
    alone.joints = {same};
    const auto rows = make_scene_model<double>(alone)->rows;
    for (Eigen::Index i = 0; i < rows; ++i) result.push_back({joint.name, int(i)});
  }
  return result;
}

AssembledScene assemble(const SceneDescription& given, const std::string& place) {
  AssembledScene result;
  result.scene = given;
  auto model = make_scene_model<double>(given);
  const std::vector<RowOfJoint> rows = rows_of_joints(given);
  const Gap before = largest_gap(System(model), model->q);
  result.gap_before = result.gap_after = before.size;
  if (!rows.empty()) result.gap_joint = rows[before.row].joint;
  if (result.moved()) {
    result.scene = CeresAssembly(given, *model).solve();
    model = make_scene_model<double>(result.scene);
  }
  const System system(model);
  std::vector<bool> implied =
      implied_rows(system, model->q, rank_tolerance(largest_gap(system, model->q).size));
  for (std::size_t r = 0; r < implied.size(); ++r)
    if (implied[r] && (result.redundant_joints.empty() || result.redundant_joints.back() != rows[r].joint))
      result.redundant_joints.push_back(rows[r].joint);
  if (!result.redundant_joints.empty()) result.implied = std::move(implied);
  // To round-off, by Newton's method in the norm of the mass matrix, with the independent constraints; the others must follow.
  const System independent(make_scene_model<double>(result.scene, result.implied));
  Eigen::VectorXd q = independent.initial_configuration(), v = independent.initial_velocity();
  NoAudit audit;
  const StepResult projected = project_on_constraints(independent, 0.0, q, v, audit);
  const Gap after = largest_gap(system, q);
  result.gap_after = after.size;
  if (projected.outcome != Outcome::ok || !(after.size < largest_gap_allowed))
    throw InputError(place,
                     fmt::format("the scene cannot be assembled: joint \"{}\" is left with a gap of {:.3g}; "
                                 "largest gap of the poses as given: {:.3g}, joint \"{}\"",
                                 rows[after.row].joint, after.size, before.size, result.gap_joint));
  if (!result.implied.empty())
    if (const Gap beside = gap_beside(system, independent, q); !(beside.size < largest_gap_allowed))
      throw InputError(
          place,
          fmt::format("the mechanism begins in a singular place: a constraint of joint \"{}\" is implied "
                      "by others there, but not beside it (gap of {:.3g}); choose other initial poses",
                      rows[beside.row].joint, beside.size));
  return result;
}

}  // namespace liebench
