#include "problems/scene_derivatives.h"

#include <ceres/jet.h>

#include <tuple>
#include <vector>

#include "groups/counted.h"
#include "problems/effects/list.h"
#include "problems/scene_constraints.h"
#include "problems/scene_system.h"

namespace liebench {

namespace {

// The state as a function of (delta x, delta theta), R -> R exp(delta theta~), whose derivatives begin at `first`.
template <class Jet, class T>
RigidState<Jet> with_pose_jets(const RigidState<T>& s, int first) {
  RigidState<Jet> jets{s.x.template cast<Jet>(), s.R.template cast<Jet>(), s.u.template cast<Jet>(),
                       s.omega.template cast<Jet>()};
  Eigen::Matrix<Jet, 3, 3> turn = Eigen::Matrix<Jet, 3, 3>::Identity();
  for (int i = 0; i < 3; ++i) {
    jets.x(i).v(first + i) = T(1.0);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    turn(k, j).v(first + 3 + i) = T(1.0);
    turn(j, k).v(first + 3 + i) = T(-1.0);
  }
  jets.R = (jets.R * turn).eval();
  return jets;
}

template <class Jet>
void add_velocity_jets(RigidState<Jet>& jets, int first) {
  for (int i = 0; i < 3; ++i) {
    jets.u(i).v(first + i) = typename Jet::Scalar(1.0);
    jets.omega(i).v(first + 3 + i) = typename Jet::Scalar(1.0);
  }
}

template <class T, class Jet>
Eigen::Matrix<T, 6, 6> derivative(const Wrench<Jet>& w, int first) {
  Eigen::Matrix<T, 6, 6> D;
  for (int i = 0; i < 3; ++i) {
    D.row(i) = w.force(i).v.template segment<6>(first).transpose();
    D.row(3 + i) = w.torque(i).v.template segment<6>(first).transpose();
  }
  return D;
}

}  // namespace

template <class Effect, class T>
WrenchDerivatives<T> effect_derivatives(const Effect& effect, const T& t, const RigidState<T>& a,
                                        const RigidState<T>& b) {
  // Poses of a and b, then velocities of a and b; what does not count has no derivatives.
  constexpr int bodies = Effect::two_bodies ? 2 : 1;
  constexpr int velocities = 6 * bodies;
  using Jet = ceres::Jet<T, Effect::uses_velocity ? 2 * velocities : velocities>;
  RigidState<Jet> jets_a = with_pose_jets<Jet>(a, 0), jets_b = RigidState<Jet>::ground();
  if constexpr (Effect::two_bodies) jets_b = with_pose_jets<Jet>(b, 6);
  if constexpr (Effect::uses_velocity) {
    add_velocity_jets(jets_a, velocities);
    if constexpr (Effect::two_bodies) add_velocity_jets(jets_b, velocities + 6);
  }
  Wrench<Jet> on_a = Wrench<Jet>::zero(), on_b = Wrench<Jet>::zero();
  effect.template add_wrenches<Jet>(t, jets_a, jets_b, on_a, on_b);
  WrenchDerivatives<T> D;
  for (int j = 0; j < bodies; ++j) {
    D.pose[0][std::size_t(j)] = derivative<T>(on_a, 6 * j);
    D.pose[1][std::size_t(j)] = derivative<T>(on_b, 6 * j);
    if constexpr (Effect::uses_velocity) {
      D.velocity[0][std::size_t(j)] = derivative<T>(on_a, velocities + 6 * j);
      D.velocity[1][std::size_t(j)] = derivative<T>(on_b, velocities + 6 * j);
    }
  }
  return D;
}

template <class Constraint, class T>
ConstraintDerivatives<Constraint, T> constraint_derivatives(
    const Constraint& constraint, const T& t, const RigidState<T>& a, const RigidState<T>& b,
    const Eigen::Matrix<T, Constraint::rows, 1>& lambda) {
  using Jet = ceres::Jet<T, 12>;
  const RigidState<Jet> jets_a = with_pose_jets<Jet>(a, 0), jets_b = with_pose_jets<Jet>(b, 6);
  Wrench<Jet> on_a = Wrench<Jet>::zero(), on_b = Wrench<Jet>::zero();
  constraint.template add_wrenches<Jet>(jets_a, jets_b, lambda.template cast<Jet>(), on_a, on_b);
  const Eigen::Matrix<Jet, Constraint::rows, 1> rate =
      constraint.template rate<Jet>(t, jets_a, jets_b, false);
  ConstraintDerivatives<Constraint, T> D;
  for (int j = 0; j < 2; ++j) {
    D.pose[0][std::size_t(j)] = derivative<T>(on_a, 6 * j);
    D.pose[1][std::size_t(j)] = derivative<T>(on_b, 6 * j);
    for (int r = 0; r < Constraint::rows; ++r)
      D.rate[std::size_t(j)].row(r) = rate(r).v.template segment<6>(6 * j).transpose();
  }
  return D;
}

namespace {

// Every effect and constraint of the lists.
template <class T, class... Effects>
auto of_effects(const std::tuple<std::vector<Placed<Effects>>...>&) {
  return std::tuple{&effect_derivatives<Effects, T>...};
}
template <class T, class... Constraints>
auto of_constraints(const std::tuple<std::vector<PlacedConstraint<Constraints>>...>&) {
  return std::tuple{&constraint_derivatives<Constraints, T>...};
}

}  // namespace

// Never called: its only purpose is that the functions above exist.
auto compiled_scene_derivatives() {
  return std::tuple{of_effects<double>(SceneEffects<double>{}), of_effects<Counted>(SceneEffects<Counted>{}),
                    of_constraints<double>(SceneConstraints<double>{}),
                    of_constraints<Counted>(SceneConstraints<Counted>{})};
}

}  // namespace liebench
