#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "groups/entrywise.h"
#include "problems/effects/list.h"
#include "problems/scene_constraints.h"
#include "problems/scene_derivatives.h"
#include "problems/scene_group.h"
#include "problems/system.h"

// A scene as a mechanical system: bodies, constraints and effects, and nothing that it does not name. Its size is known at run
// time; with a bound on the number of bodies its vectors need no heap.

namespace liebench {

template <class Constraint>
struct PlacedConstraint {
  Constraint constraint;
  int a, b;  // bodies, -1 for the ground
  // The places of its rows among the multipliers; -1 for one that other constraints imply, which is left out.
  std::array<Eigen::Index, std::size_t(Constraint::rows)> row;

  template <class Value, class T>
  void scatter(const Value& value, T* all) const {
    if (complete()) {
      for (int r = 0; r < Constraint::rows; ++r) all[row[0] + r] = value(r);
      return;
    }
    for (int r = 0; r < Constraint::rows; ++r)
      if (row[std::size_t(r)] >= 0) all[row[std::size_t(r)]] = value(r);
  }
  template <class T>
  Eigen::Matrix<T, Constraint::rows, 1> gathered(const T* all) const {
    Eigen::Matrix<T, Constraint::rows, 1> own;
    if (complete()) {
      for (int r = 0; r < Constraint::rows; ++r) own(r) = all[row[0] + r];
      return own;
    }
    for (int r = 0; r < Constraint::rows; ++r)
      own(r) = row[std::size_t(r)] >= 0 ? all[row[std::size_t(r)]] : T(0.0);
    return own;
  }
  // Without a row that is left out: one after the other.
  bool complete() const { return row[0] >= 0 && row.back() == row[0] + Constraint::rows - 1; }
};

template <class T>
using SceneConstraints =
    std::tuple<std::vector<PlacedConstraint<Coincidence<T>>>, std::vector<PlacedConstraint<Perpendicular<T>>>,
               std::vector<PlacedConstraint<InPlane<T>>>, std::vector<PlacedConstraint<Distance<T>>>,
               std::vector<PlacedConstraint<PrescribedAngle<T>>>>;

template <class T>
struct SceneModel {
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  std::vector<Body<T>> bodies;
  SceneConstraints<T> constraints;
  SceneEffects<T> effects;
  Eigen::Index rows = 0;  // of all constraints
  Vector q, v;            // initial values
  RigidState<T> ground = RigidState<T>::ground();
  Eigen::Matrix<T, 3, 1> vertical = {T(0.0), T(0.0), T(1.0)};  // for the angular momentum
};

template <class T, int most_bodies = Eigen::Dynamic>
class SceneSystem {
 public:
  using Scalar = T;
  using Group = SceneGroup<T, most_bodies>;
  using Element = typename Group::Element;
  using Tangent = typename Group::Tangent;
  static constexpr int constraints = Eigen::Dynamic;
  static constexpr int most_constraints = Group::most;
  using Multipliers = Eigen::Matrix<T, Eigen::Dynamic, 1, 0, most_constraints, 1>;
  using Linear = LinearScalar<T>;
  template <class U>
  using rebind = SceneSystem<U, most_bodies>;
  using State = RigidState<T>;
  using Block6 = Eigen::Matrix<Linear, 6, 6>;

  explicit SceneSystem(std::shared_ptr<const SceneModel<T>> model)
      : model_(std::move(model)),
        size_(Group(model_->bodies).size()),
        used_effects_(used_lists(model_->effects)),
        used_constraints_(used_lists(model_->constraints)) {}
  const SceneModel<T>& model() const { return *model_; }

  Group group() const { return Group(model_->bodies, size_); }
  Eigen::Index multipliers() const { return model_->rows; }
  Element initial_configuration() const { return model_->q; }
  Tangent initial_velocity() const { return model_->v; }

  Tangent momentum(const Element&, const Tangent& w) const {
    return inlined<T>([&]() -> Tangent {
      Tangent p(w.size());
      for (const Body<T>& body : model_->bodies) body.add_momentum(w, p);
      return p;
    });
  }
  Tangent force(const T& t, const Element& q, const Tangent& v) const {
    return inlined<T>([&]() -> Tangent {
      Tangent g(v.size());
      put_force(t, Seen(*this, q, &v), v, g);
      return g;
    });
  }
  T energy(const Element& q, const Tangent& v) const {
    T sum = T(0.5) * v.dot(momentum(q, v));
    each_effect([&](const auto& placed) {
      if constexpr (requires { placed.effect.template energy<T>(State{}, State{}); }) {
        const Pair<T> pair = states(placed.a, placed.b, q, nullptr);
        sum += placed.effect.template energy<T>(pair.a, pair.b);
      }
    });
    return sum;
  }
  // About the origin.
  T angular_momentum(const Element& q, const Tangent& v) const {
    Eigen::Matrix<T, 3, 1> sum = Eigen::Matrix<T, 3, 1>::Constant(T(0.0));
    for (const Body<T>& body : model_->bodies) {
      const State s = state(body, q, &v);
      sum += body.mass * s.x.cross(s.u);
      if (body.rotates()) sum += s.R * (body.inertia * s.omega);
    }
    return model_->vertical.dot(sum);
  }

  Multipliers constraint(const T& t, const Element& q) const {
    return inlined<T>([&]() -> Multipliers {
      Multipliers phi(multipliers());
      put_constraint(t, Seen(*this, q), phi.data());
      return phi;
    });
  }
  Multipliers constraint_rate(const T& t, const Element& q, const Tangent& v) const {
    return rate(t, q, v, true);
  }
  Multipliers constraint_product(const Element& q, const Tangent& w) const {
    return rate(T(0.0), q, w, false);
  }
  Multipliers constraint_curvature(const T& t, const Element& q, const Tangent& v) const {
    Multipliers z(multipliers());
    each_constraint([&]<class C>(const PlacedConstraint<C>& c) {
      const Pair<T> pair = states(c.a, c.b, q, &v);
      Eigen::Matrix<T, C::rows, 1> curvature = c.constraint.template curvature<T>(t, pair.a, pair.b);
      if (!plain(c.a) || !plain(c.b)) {
        Pair<T> drift = pair;
        set_drift(c.a, drift.a);
        set_drift(c.b, drift.b);
        curvature += c.constraint.template rate<T>(t, drift.a, drift.b, false);
      }
      c.scatter(curvature, z.data());
    });
    return z;
  }
  Tangent constraint_force(const Element& q, const Multipliers& lambda) const {
    Tangent forces;
    put_constraint_force(q, lambda.data(), forces);
    return forces;
  }

  // See InPlaceSystem.
  void put_constraint_force(const Element& q, const T* lambda, Tangent& forces) const {
    inlined<T>([&] {
      forces.resize(group().size());
      put_constraint_force(Seen(*this, q), lambda, forces);
    });
  }
  void put_step_residual(const T& t, const T& h, const Element& q, const Tangent& v, const Tangent& w,
                         const T* lambda, T* r, T* rates) const {
    inlined<T>([&] {
      const Eigen::Index size = v.size();
      // No velocity is asked for by gravity, the first of the effects.
      static_assert(!Gravity::uses_velocity);
      const Seen seen(*this, q, used_effects_ > 1 || rates != nullptr ? &v : nullptr);
      Tangent applied(size), forces(size);
      put_applied(t, seen, applied);
      set_zero(forces);
      each_constraint([&]<class C>(const PlacedConstraint<C>& c) {
        add_constraint_force(c, seen, lambda, forces);
        c.scatter(residual(c, t, seen) / h, r + size);
        if (rates != nullptr) c.scatter(rate(c, t, seen, true), rates);
      });
      Eigen::Map<Eigen::Matrix<T, Eigen::Dynamic, 1>> rows(r, size);
      for (const Body<T>& body : model_->bodies) body.put_equation(h, w, v, forces, applied, rows);
    });
  }

  // The pieces of Newton and saddle point matrices, each with the place where it belongs:
  //
  //   sink.stiffness(i, j, K_ij)   D_{q_j} of (g + B^T lambda)_i
  //   sink.damping(i, j, C_ij)     D_{v_j} of g_i
  //   sink.turning_stiffness(i, K), sink.turning_damping(i, C)   K_ii and C_ii of a plain body: the rotational 3 x 3 blocks, the rest zero
  //   sink.gradient(row, j, B_j)   a row of the constraint gradient
  //   sink.rate_gradient(row, j, Z_j)   the same row of D_{q_j} of (B v) at fixed v, where the sink asks for it
  //
  // i, j are bodies. The same pieces in the same order at every point.
  template <class Sink>
  void linearize(const T& t, const Element& q, const Tangent& v, const Multipliers& lambda,
                 Sink& sink) const {
    each_effect([&]<class E>(const Placed<E>& placed) { effect_pieces(placed, t, q, v, sink); });
    for (std::size_t i = 0; i < model_->bodies.size(); ++i) {
      const Body<T>& body = model_->bodies[i];
      if (!body.has_inertial_forces()) continue;
      if (body.plain())
        sink.turning_damping(int(i), body.gyroscopic_damping(v));
      else
        sink.damping(int(i), int(i), body.inertial_damping(v));
    }
    each_constraint(
        [&]<class C>(const PlacedConstraint<C>& c) { constraint_pieces(c, t, q, v, lambda, sink); });
  }
  // The constraint gradient alone.
  template <class Sink>
  void gradient(const Element& q, Sink& sink) const {
    each_constraint([&]<class C>(const PlacedConstraint<C>& c) {
      const Pair<T> pair = states(c.a, c.b, q, nullptr);
      gradient_pieces(c, pair, sink);
    });
  }

 private:
  template <class U>
  struct Pair {
    RigidState<U> a, b;
    Wrench<U> on_a = Wrench<U>::zero(), on_b = Wrench<U>::zero();
  };
  using Gravity = decltype(std::tuple_element_t<0, SceneEffects<T>>::value_type::effect);
  template <class U>
  using Block = Eigen::Matrix<U, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

  // The states of the bodies at a point, -1 that of the ground: of few bodies read once, of many where they are asked for.
  class Seen {
   public:
    Seen(const SceneSystem& system, const Element& q, const Tangent* v = nullptr)
        : system_(system), q_(q), v_(v) {
      if constexpr (few)
        for (std::size_t i = 0; i < system.model_->bodies.size(); ++i)
          read(system.model_->bodies[i], q, v, states_[i]);
    }
    decltype(auto) operator()(int body) const {
      if constexpr (few)
        return (body < 0 ? system_.model_->ground : states_[std::size_t(body)]);
      else
        return system_.state(body, q_, v_);
    }
    const State& ground() const { return system_.model_->ground; }

   private:
    static constexpr bool few = most_bodies != Eigen::Dynamic;
    const SceneSystem& system_;
    const Element& q_;
    const Tangent* v_;
    std::array<State, std::size_t(few ? most_bodies : 0)> states_;
  };

  template <class Visitor>
  void each_effect(const Visitor& visit) const {
    visit_lists(model_->effects, used_effects_, visit);
  }
  template <class Visitor>
  void each_constraint(const Visitor& visit) const {
    visit_lists(model_->constraints, used_constraints_, visit);
  }
  // How many lists there are up to the last that is not empty.
  template <class Lists>
  static int used_lists(const Lists& lists) {
    int used = 0, i = 0;
    std::apply([&](const auto&... list) { ((++i, used = list.empty() ? used : i), ...); }, lists);
    return used;
  }
  template <class Lists, class Visitor>
  static void visit_lists(const Lists& lists, int used, const Visitor& visit) {
    std::apply([&](const auto&... list) { (void)((used-- > 0 && (visit_all(list, visit), true)) && ...); },
               lists);
  }
  template <class List, class Visitor>
  static void visit_all(const List& list, const Visitor& visit) {
    for (const auto& placed : list) visit(placed);
  }

  static State state(const Body<T>& body, const Element& q, const Tangent* v) {
    State s;
    read(body, q, v, s);
    return s;
  }
  static void read(const Body<T>& body, const Element& q, const Tangent* v, State& s) {
    body.read_pose(q, s);
    if (v != nullptr) body.read_velocity(*v, s);
  }
  State state(int body, const Element& q, const Tangent* v) const {
    return body < 0 ? State::ground() : state(model_->bodies[std::size_t(body)], q, v);
  }
  Pair<T> states(int a, int b, const Element& q, const Tangent* v) const {
    return {state(a, q, v), state(b, q, v)};
  }
  bool plain(int body) const { return body < 0 || model_->bodies[std::size_t(body)].plain(); }
  // In place of the velocities: x'' and Omega' where the velocities v of the body do not change.
  void set_drift(int body, State& s) const {
    s.u = body < 0 ? State::ground().u : model_->bodies[std::size_t(body)].drift(s);
    s.omega = State::ground().omega;
  }
  void add(int body, const State& s, const Wrench<T>& wrench, Tangent& forces) const {
    if (body >= 0) model_->bodies[std::size_t(body)].add(s, wrench, forces);
  }
  static void set_zero(Tangent& x) {
    each_entry(x.size(), [&](Eigen::Index i) { x(i) = T(0.0); });
  }
  void put_force(const T& t, const Seen& seen, const Tangent& v, Tangent& g) const {
    put_applied(t, seen, g);
    each_entry(g.size(), [&](Eigen::Index i) { g(i) = -g(i); });
    for (const Body<T>& body : model_->bodies)
      if (body.has_inertial_forces()) body.add_inertial(v, g);
  }
  void put_applied(const T& t, const Seen& seen, Tangent& g) const {
    set_zero(g);
    each_effect([&](const auto& placed) {
      const auto& effect = placed.effect;
      using Effect = std::remove_cvref_t<decltype(effect)>;
      Wrench<T> on_a = Wrench<T>::zero(), on_b = on_a;
      if constexpr (!Effect::two_bodies && !Effect::uses_pose && !Effect::uses_velocity)
        if (plain(placed.a)) {
          // Neither the effect nor what its force is for the velocities depends on the state.
          effect.template add_wrenches<T>(t, seen.ground(), seen.ground(), on_a, on_b);
          return add(placed.a, seen.ground(), on_a, g);
        }
      const State &a = seen(placed.a), &b = seen(placed.b);
      effect.template add_wrenches<T>(t, a, b, on_a, on_b);
      add(placed.a, a, on_a, g);
      if constexpr (Effect::two_bodies) add(placed.b, b, on_b, g);
    });
  }
  // A joint to the ground that does not need its state. What counts takes the long way, so that its counts stay.
  template <class C>
  static bool on_ground(const PlacedConstraint<C>& c) {
    if constexpr (!std::is_same_v<T, double>) return false;
    return c.a < 0 && c.b >= 0;
  }
  template <class C>
  void add_constraint_force(const PlacedConstraint<C>& c, const Seen& seen, const T* lambda,
                            Tangent& forces) const {
    const auto own = c.gathered(lambda);
    const State& b = seen(c.b);
    if constexpr (requires { c.constraint.wrench_on_ground(b, own); })
      if (on_ground(c)) return add(c.b, b, c.constraint.wrench_on_ground(b, own), forces);
    const State& a = seen(c.a);
    Wrench<T> on_a = Wrench<T>::zero(), on_b = on_a;
    c.constraint.template add_wrenches<T>(a, b, own, on_a, on_b);
    add(c.a, a, on_a, forces);
    add(c.b, b, on_b, forces);
  }
  template <class C>
  Eigen::Matrix<T, C::rows, 1> residual(const PlacedConstraint<C>& c, const T& t, const Seen& seen) const {
    const State& b = seen(c.b);
    if constexpr (requires { c.constraint.residual_on_ground(b); })
      if (on_ground(c)) return c.constraint.residual_on_ground(b);
    return c.constraint.template residual<T>(t, seen(c.a), b);
  }
  void put_constraint_force(const Seen& seen, const T* lambda, Tangent& forces) const {
    set_zero(forces);
    each_constraint([&](const auto& c) { add_constraint_force(c, seen, lambda, forces); });
  }
  void put_constraint(const T& t, const Seen& seen, T* phi) const {
    each_constraint([&](const auto& c) { c.scatter(residual(c, t, seen), phi); });
  }
  template <class C>
  Eigen::Matrix<T, C::rows, 1> rate(const PlacedConstraint<C>& c, const T& t, const Seen& seen,
                                    bool moving) const {
    const State& b = seen(c.b);
    if constexpr (requires { c.constraint.rate_on_ground(b); })
      if (on_ground(c)) return c.constraint.rate_on_ground(b);
    return c.constraint.template rate<T>(t, seen(c.a), b, moving);
  }
  void put_rate(const T& t, const Seen& seen, bool moving, T* r) const {
    each_constraint([&](const auto& c) { c.scatter(rate(c, t, seen, moving), r); });
  }
  Multipliers rate(const T& t, const Element& q, const Tangent& v, bool moving) const {
    return inlined<T>([&]() -> Multipliers {
      Multipliers r(multipliers());
      put_rate(t, Seen(*this, q, &v), moving, r.data());
      return r;
    });
  }

  // D(A^T w) for the wrench w on body i as a function of the pose (K) and the velocity (C) of body j, with the sign.
  template <class Sink>
  void wrench_pieces(int i, const State& s_i, int j, const State& s_j, const Eigen::Matrix<T, 6, 6>& K,
                     const Eigen::Matrix<T, 6, 6>* C, const Wrench<T>& w, T sign, Sink& sink) const {
    if (i < 0 || j < 0) return;
    const Body<T>& body_i = model_->bodies[std::size_t(i)];
    const Body<T>& body_j = model_->bodies[std::size_t(j)];
    if (body_i.plain() && body_j.plain()) {
      if (C != nullptr) sink.damping(i, j, Block<T>(sign * (*C)));
      sink.stiffness(i, j, Block<T>(sign * K));
      return;
    }
    const auto A_i = body_i.motion(s_i), A_j = body_j.motion(s_j);
    Block<T> stiffness = A_i.transpose() * (K * A_j);
    if (C != nullptr) {
      stiffness += A_i.transpose() * ((*C) * body_j.motion_derivative(s_j));
      sink.damping(i, j, Block<T>(sign * (A_i.transpose() * ((*C) * A_j))));
    }
    if (i == j) stiffness += body_i.force_derivative(s_i, w.force);
    sink.stiffness(i, j, Block<T>(sign * stiffness));
  }

  // Of an effect; g = -applied.
  template <class E, class Sink>
  void effect_pieces(const Placed<E>& placed, const T& t, const Element& q, const Tangent& v,
                     Sink& sink) const {
    Pair<T> pair = states(placed.a, placed.b, q, &v);
    placed.effect.template add_wrenches<T>(t, pair.a, pair.b, pair.on_a, pair.on_b);
    if constexpr (!E::uses_pose && !E::uses_velocity) {
      // What turns with the body is left where its velocities are body-fixed.
      const Body<T>& body = model_->bodies[std::size_t(placed.a)];
      if (!body.plain() && body.rotates())
        sink.stiffness(placed.a, placed.a, Block<T>(-body.force_derivative(pair.a, pair.on_a.force)));
    } else {
      const WrenchDerivatives<T> D = effect_derivatives(placed.effect, t, pair.a, pair.b);
      const std::array<int, 2> bodies{placed.a, placed.b};
      const std::array<const State*, 2> at{&pair.a, &pair.b};
      const std::array<const Wrench<T>*, 2> wrenches{&pair.on_a, &pair.on_b};
      constexpr std::size_t count = E::two_bodies ? 2 : 1;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j)
          wrench_pieces(bodies[i], *at[i], bodies[j], *at[j], D.pose[i][j],
                        E::uses_velocity ? &D.velocity[i][j] : nullptr, *wrenches[i], T(-1.0), sink);
    }
  }

  // The row r of a constraint in (x, theta) of its bodies: the wrenches of a unit multiplier.
  struct Wrenches {
    Wrench<T> on_a, on_b;
  };
  template <class C>
  static Wrenches gradient_row(const PlacedConstraint<C>& c, const Pair<T>& pair, int r) {
    Wrenches result{pair.on_a, pair.on_b};
    Eigen::Matrix<T, C::rows, 1> unit = Eigen::Matrix<T, C::rows, 1>::Constant(T(0.0));
    unit(r) = T(1.0);
    c.constraint.template add_wrenches<T>(pair.a, pair.b, unit, result.on_a, result.on_b);
    return result;
  }
  static Eigen::Matrix<T, 1, 6> row_of(const Wrench<T>& w) {
    Eigen::Matrix<T, 1, 6> row;
    row << w.force.transpose(), w.torque.transpose();
    return row;
  }
  template <class C, class Sink>
  void gradient_pieces(const PlacedConstraint<C>& c, const Pair<T>& pair, Sink& sink) const {
    for (int r = 0; r < C::rows; ++r) {
      const Eigen::Index row = c.row[std::size_t(r)];
      if (row < 0) continue;
      const Wrenches unit = gradient_row(c, pair, r);
      const auto piece = [&](int i, const State& s, const Wrench<T>& w) {
        if (i < 0) return;
        const Body<T>& body = model_->bodies[std::size_t(i)];
        if (body.plain())
          sink.gradient(row, i, row_of(w));
        else
          sink.gradient(row, i, Block<T>(row_of(w) * body.motion(s)));
      };
      piece(c.a, pair.a, unit.on_a);
      piece(c.b, pair.b, unit.on_b);
    }
  }

  template <class C, class Sink>
  void constraint_pieces(const PlacedConstraint<C>& c, const T& t, const Element& q, const Tangent& v,
                         const Multipliers& lambda, Sink& sink) const {
    const Pair<T> pair = states(c.a, c.b, q, &v);
    gradient_pieces(c, pair, sink);
    if constexpr (requires { C::only_turning; })
      turning_pieces(c, pair, lambda, sink);
    else
      jet_pieces(c, pair, t, lambda, sink);
  }
  // Of a constraint whose force on a body depends on the rotation of this body alone.
  template <class C, class Sink>
  void turning_pieces(const PlacedConstraint<C>& c, const Pair<T>& pair, const Multipliers& lambda,
                      Sink& sink) const {
    const auto own = c.gathered(lambda.data());
    Pair<T> forces = pair;
    c.constraint.template add_wrenches<T>(pair.a, pair.b, own, forces.on_a, forces.on_b);
    const auto [turn_a, turn_b] = c.constraint.turning_stiffness(pair.a, pair.b, own);
    const auto [rate_a, rate_b] = c.constraint.turning_rate(pair.a, pair.b);
    const auto piece = [&](int i, const State& s, const Wrench<T>& w, const Eigen::Matrix<T, 3, 3>& turn,
                           const Eigen::Matrix<T, C::rows, 3>& rate, bool first) {
      if (i < 0) return;
      if (plain(i)) {
        sink.turning_stiffness(i, turn);
      } else {
        Eigen::Matrix<T, 6, 6> K = Eigen::Matrix<T, 6, 6>::Constant(T(0.0));
        K.template bottomRightCorner<3, 3>() = turn;
        wrench_pieces(i, s, i, s, K, nullptr, w, T(1.0), sink);
      }
      if constexpr (Sink::wants_rate_gradient) {
        const Body<T>& body = model_->bodies[std::size_t(i)];
        for (int r = 0; r < C::rows; ++r) {
          const Eigen::Index row = c.row[std::size_t(r)];
          if (row < 0) continue;
          Eigen::Matrix<T, 1, 6> direct = Eigen::Matrix<T, 1, 6>::Constant(T(0.0));
          direct.template tail<3>() = rate.row(r);
          if (std::is_same_v<T, double> && body.plain()) {
            // motion(s) is the identity, and motion_derivative(s) zero. What counts
            // takes the long way.
            sink.rate_gradient(row, i, direct);
            continue;
          }
          const Wrenches unit = gradient_row(c, pair, r);
          sink.rate_gradient(row, i,
                             Block<T>(direct * body.motion(s) +
                                      row_of(first ? unit.on_a : unit.on_b) * body.motion_derivative(s)));
        }
      }
    };
    piece(c.a, pair.a, forces.on_a, turn_a, rate_a, true);
    piece(c.b, pair.b, forces.on_b, turn_b, rate_b, false);
  }
  template <class C, class Sink>
  void jet_pieces(const PlacedConstraint<C>& c, const Pair<T>& pair, const T& t, const Multipliers& lambda,
                  Sink& sink) const {
    const auto own = c.gathered(lambda.data());
    Pair<T> forces = pair;
    c.constraint.template add_wrenches<T>(pair.a, pair.b, own, forces.on_a, forces.on_b);
    const ConstraintDerivatives<C, T> D = constraint_derivatives(c.constraint, t, pair.a, pair.b, own);
    const std::array<int, 2> bodies{c.a, c.b};
    const std::array<const State*, 2> at{&pair.a, &pair.b};
    const std::array<const Wrench<T>*, 2> wrenches{&forces.on_a, &forces.on_b};
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j)
        wrench_pieces(bodies[i], *at[i], bodies[j], *at[j], D.pose[i][j], nullptr, *wrenches[i], T(1.0),
                      sink);
    if constexpr (Sink::wants_rate_gradient)
      for (int r = 0; r < C::rows; ++r) {
        const Eigen::Index row = c.row[std::size_t(r)];
        if (row < 0) continue;
        const Wrenches unit = gradient_row(c, pair, r);
        for (std::size_t i = 0; i < 2; ++i) {
          if (bodies[i] < 0) continue;
          // The velocities (x', Omega) move with q, too.
          const Body<T>& body = model_->bodies[std::size_t(bodies[i])];
          const Eigen::Matrix<T, 1, 6> direct = D.rate[i].row(r);
          sink.rate_gradient(row, bodies[i],
                             Block<T>(direct * body.motion(*at[i]) + row_of(i == 0 ? unit.on_a : unit.on_b) *
                                                                         body.motion_derivative(*at[i])));
        }
      }
  }

  std::shared_ptr<const SceneModel<T>> model_;
  Eigen::Index size_;  // of the velocities
  int used_effects_, used_constraints_;
};

}  // namespace liebench
