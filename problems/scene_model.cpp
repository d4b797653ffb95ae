#include "problems/scene_model.h"

#include <Eigen/Core>
#include <cstddef>
#include <tuple>
#include <utility>

#include "groups/counted.h"
#include "groups/decimal.h"
#include "groups/extended.h"

namespace liebench {

namespace {

template <class T>
class ModelBuilder {
 public:
  using Vector = Eigen::Matrix<T, 3, 1>;

  ModelBuilder(const SceneDescription& scene, const std::vector<bool>& implied) : implied_(implied) {
    Eigen::Index coordinates = 0, velocities = 0;
    for (const BodyDescription& d : scene.bodies) {
      Body<T> body = make_body(d);
      body.q = coordinates;
      body.v = velocities;
      coordinates += body.coordinates();
      velocities += body.velocities();
      model_.bodies.push_back(std::move(body));
    }
    model_.q.resize(coordinates);
    model_.v.resize(velocities);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) put_state(scene.bodies[i], model_.bodies[i]);
    for (const JointDescription& joint : scene.joints) add_joint(joint);
    std::apply([&](const auto&... lists) { (add_effects(lists), ...); }, scene.effects);
    for (const auto& placed : std::get<std::vector<Placed<UniformGravity<double>>>>(scene.effects))
      if (placed.effect.gravity.norm() > 0.0) {
        const Vector gravity = decimal_vector<T>(placed.effect.gravity);
        model_.vertical = -gravity / gravity.norm();
        break;
      }
  }
  SceneModel<T> take() { return std::move(model_); }

 private:
  static Body<T> make_body(const BodyDescription& d) {
    Body<T> body;
    body.kind = d.kind;
    body.mass = decimal<T>(d.mass);
    body.inertia = decimal_matrix<T>(d.inertia);
    if (has_fixed_point(d.kind)) {
      body.fixed_point = decimal_vector<T>(d.fixed_point);
      body.arm = rotation(d).transpose() * (decimal_vector<T>(d.position) - body.fixed_point);
      body.inertia_of_motion =
          body.inertia + body.mass * (body.arm.squaredNorm() * Eigen::Matrix<T, 3, 3>::Identity() -
                                      body.arm * body.arm.transpose());
    }
    // Omega x J Omega vanishes where J is a multiple of the identity.
    const auto& J = has_fixed_point(d.kind) ? body.inertia_of_motion : body.inertia;
    const bool ball = J == Eigen::Matrix<T, 3, 3>(J(0, 0) * Eigen::Matrix<T, 3, 3>::Identity());
    body.gyroscopic = d.gyroscopic && body.rotates() && !ball;
    return body;
  }
  static Eigen::Matrix<T, 3, 3> rotation(const BodyDescription& d) {
    Quaternion<T> p;
    for (Eigen::Index i = 0; i < 4; ++i) p(i) = decimal<T>(d.orientation(i));
    return rotation_matrix<T>(Quaternion<T>(p / p.norm()));
  }
  void put_state(const BodyDescription& d, const Body<T>& body) {
    const Eigen::Matrix<T, 3, 3> R = rotation(d);
    const Vector x = decimal_vector<T>(d.position), u = decimal_vector<T>(d.velocity);
    const Vector omega = decimal_vector<T>(d.angular_velocity);
    visit_group<T>(body.kind, [&]<class G>(G) {
      auto place = model_.q.template segment<G::Stacked::RowsAtCompileTime>(body.q);
      if constexpr (G::dimension == 6)
        place = G::stacked(G::representative({x, R}));
      else if constexpr (G::commutative)
        place = x;
      else
        place = G::stacked(G::representative(R));
    });
    if (has_fixed_point(body.kind)) {
      model_.v.template segment<3>(body.v) = omega;
      return;
    }
    model_.v.template segment<3>(body.v) = has_body_velocity(body.kind) ? Vector(R.transpose() * u) : u;
    if (body.rotates()) model_.v.template segment<3>(body.v + 3) = omega;
  }

  template <class C>
  void add(int a, int b, const C& constraint) {
    PlacedConstraint<C> placed{constraint, a, b, {}};
    for (auto& row : placed.row) {
      row = next_ < implied_.size() && implied_[next_] ? -1 : model_.rows++;
      ++next_;
    }
    std::get<std::vector<PlacedConstraint<C>>>(model_.constraints).push_back(placed);
  }
  void add_joint(const JointDescription& j) {
    const auto vector = [](const Eigen::Vector3d& v) { return decimal_vector<T>(v); };
    const auto unit = [](const Eigen::Vector3d& v) {
      const Vector u = decimal_vector<T>(v);
      return Vector(u / u.norm());
    };
    const Vector p_a = vector(j.point_a), p_b = vector(j.point_b);
    const Vector n_a = unit(j.axis_a), n_b = unit(j.axis_b), e_a = unit(j.across_a), e_b = unit(j.across_b);
    const Vector f_a = n_a.cross(e_a);
    const auto point = [&] { add(j.a, j.b, Coincidence<T>{p_a, p_b}); };
    const auto perpendicular = [&](const Vector& n, const Vector& w) {
      add(j.a, j.b, Perpendicular<T>{n, w});
    };
    const auto in_plane = [&](const Vector& n, const PrescribedMotion<T>& c) {
      add(j.a, j.b, InPlane<T>{n, p_a, p_b, c});
    };
    const auto common_axis = [&] {
      perpendicular(e_a, n_b);
      perpendicular(f_a, n_b);
    };
    const auto along_axis = [&] {
      in_plane(e_a, {});
      in_plane(f_a, {});
    };
    switch (j.kind) {
      case JointKind::spherical:
        point();
        break;
      case JointKind::revolute:
        point();
        common_axis();
        if (j.motion) add(j.a, j.b, PrescribedAngle<T>{e_a, f_a, e_b, j.motion->template cast<T>()});
        break;
      case JointKind::prismatic:
        along_axis();
        common_axis();
        perpendicular(f_a, e_b);
        if (j.motion) in_plane(n_a, j.motion->template cast<T>());
        break;
      case JointKind::cylindrical:
        along_axis();
        common_axis();
        break;
      case JointKind::universal:
        point();
        perpendicular(n_a, n_b);
        break;
      case JointKind::planar:
        in_plane(n_a, {});
        common_axis();
        break;
      case JointKind::fixed:
        point();
        common_axis();
        perpendicular(f_a, e_b);
        break;
      case JointKind::distance:
        add(j.a, j.b, Distance<T>{p_a, p_b, decimal<T>(j.length)});
        break;
      case JointKind::point_on_plane:
        in_plane(n_a, {});
        break;
    }
  }
  template <template <class> class E>
  void add_effects(const std::vector<Placed<E<double>>>& list) {
    for (const auto& placed : list)
      std::get<std::vector<Placed<E<T>>>>(model_.effects)
          .push_back({placed.effect.template cast<T>(), placed.a, placed.b});
  }

  const std::vector<bool>& implied_;
  std::size_t next_ = 0;
  SceneModel<T> model_;
};

}  // namespace

template <class T>
std::shared_ptr<const SceneModel<T>> make_scene_model(const SceneDescription& scene,
                                                      const std::vector<bool>& implied) {
  return std::make_shared<const SceneModel<T>>(ModelBuilder<T>(scene, implied).take());
}

template std::shared_ptr<const SceneModel<double>> make_scene_model(const SceneDescription&,
                                                                    const std::vector<bool>&);
template std::shared_ptr<const SceneModel<Extended>> make_scene_model(const SceneDescription&,
                                                                      const std::vector<bool>&);
template std::shared_ptr<const SceneModel<Counted>> make_scene_model(const SceneDescription&,
                                                                     const std::vector<bool>&);

}  // namespace liebench
