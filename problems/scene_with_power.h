#pragma once

#include <Eigen/Core>
#include <tuple>

#include "problems/scene_system.h"

namespace liebench {

// A scene that knows the power of the forces that have no potential, for check_system(): steps never ask for it.
template <class T>
class SceneWithPower : public SceneSystem<T> {
 public:
  using Base = SceneSystem<T>;
  using typename Base::Element;
  using typename Base::State;
  using typename Base::Tangent;
  template <class U>
  using rebind = SceneWithPower<U>;
  using Base::Base;

  // Of the effects without an energy, and of what velocities add to the forces of the others, W.
  T power(const T& t, const Element& q, const Tangent& v) const {
    T sum(0.0);
    const auto add = [&](const auto& placed) {
      const State a = state(placed.a, q, v), b = state(placed.b, q, v);
      const auto work = [&](const State& at_a, const State& at_b) {
        Wrench<T> on_a = Wrench<T>::zero(), on_b = on_a;
        placed.effect.template add_wrenches<T>(t, at_a, at_b, on_a, on_b);
        return T(on_a.force.dot(a.u) + on_a.torque.dot(a.omega) + on_b.force.dot(b.u) +
                 on_b.torque.dot(b.omega));
      };
      sum += work(a, b);
      if constexpr (requires { placed.effect.template energy<T>(a, b); }) sum -= work(at_rest(a), at_rest(b));
    };
    std::apply(
        [&](const auto&... list) {
          const auto each = [&](const auto& effects) {
            for (const auto& placed : effects) add(placed);
          };
          (each(list), ...);
        },
        this->model().effects);
    return sum;
  }

 private:
  State state(int body, const Element& q, const Tangent& v) const {
    if (body < 0) return State::ground();
    const Body<T>& b = this->model().bodies[std::size_t(body)];
    State s;
    b.read_pose(q, s);
    b.read_velocity(v, s);
    return s;
  }
  static State at_rest(State s) {
    s.u = s.omega = State::ground().u;
    return s;
  }
};

}  // namespace liebench
