#include "harness/outside/quaternion_scene.h"

#include <Eigen/LU>
#include <utility>

#include "harness/instances/scene_steppers.h"
#include "harness/outside/scaled_rotation.h"
#include "problems/dense_pieces.h"
#include "problems/scene_model.h"

namespace liebench::outside {

namespace {

// Where y has what belongs to a body, -1 where it does not have that.
struct Places {
  Eigen::Index x, p, u, omega;
};

Places places_of(const SceneModel<double>& model, const Body<double>& body) {
  const Eigen::Index v = model.q.size() + body.v;
  if (has_fixed_point(body.kind)) return {-1, body.q, -1, v};
  if (!body.rotates()) return {body.q, -1, v, -1};
  return {body.q, body.q + 3, v, v + 3};
}

BodyKind with_quaternion(BodyKind kind) {
  switch (kind) {
    case BodyKind::r3xso3:
      return BodyKind::r3xs3;
    case BodyKind::se3:
    case BodyKind::udq:
      return BodyKind::s3_r3;
    case BodyKind::so3:
      return BodyKind::s3;
    case BodyKind::r3xs3:
    case BodyKind::s3_r3:
    case BodyKind::s3:
    case BodyKind::r3:
      break;
  }
  return kind;
}

// q of y, the quaternions normalised.
template <class Element>
Element unit_configuration(const SceneModel<double>& model, const Eigen::Ref<const Eigen::VectorXd>& y) {
  Element q = y.head(model.q.size());
  for (const Body<double>& body : model.bodies)
    if (const Eigen::Index p = places_of(model, body).p; p >= 0)
      q.template segment<4>(p) = Vector4(q.template segment<4>(p)).normalized();
  return q;
}

template <class System>
class FunctionsOf final : public QuaternionScene::Functions {
 public:
  using Vector = QuaternionScene::Vector;
  using Matrix = QuaternionScene::Matrix;

  explicit FunctionsOf(const QuaternionScene::Data& model) : system_(model) {
    for (const Body<double>& body : model->bodies)
      bodies_.push_back(
          {places_of(*model, body), has_body_velocity(body.kind), 1.0 / body.mass,
           (has_fixed_point(body.kind) ? body.inertia_of_motion : body.inertia).inverse().eval()});
  }

  void derivative(double t, Eigen::Ref<const Vector> y, Eigen::Ref<Vector> f) const override {
    const Eigen::Index n = system_.model().q.size();
    const auto q = unit_configuration<typename System::Element>(system_.model(), y);
    const typename System::Tangent v = y.tail(y.size() - n);
    const typename System::Tangent g = system_.force(t, q, v);
    for (const Inertia& b : bodies_) {
      const auto& [x, p, u, omega] = b.at;
      if (x >= 0) {
        const Vector3 velocity = y.segment<3>(u);
        f.segment<3>(x) = b.turned ? turn(y.segment<4>(p), velocity) : velocity;
        f.segment<3>(u) = -b.inverse_mass * g.template segment<3>(u - n);
      }
      if (p >= 0) {
        f.segment<4>(p) = quaternion_rate(y.segment<4>(p), y.segment<3>(omega));
        f.segment<3>(omega) = -(b.inverse_inertia * g.template segment<3>(omega - n));
      }
    }
  }

  // Of g by its pieces K and C, in the directions w of x and of the rotation (q moves to q o exp(w~)):
  //
  //   w_x = dx   (R(p)^T dx where velocities are body-fixed),   w_Omega = 2 Q(p)^T dp / |p|^2
  void jacobian(double t, Eigen::Ref<const Vector> y, Eigen::Ref<Matrix> J) const override {
    const Eigen::Index n = system_.model().q.size(), m = y.size() - n;
    const auto q = unit_configuration<typename System::Element>(system_.model(), y);
    DensePieces<System> pieces(system_);
    system_.linearize(t, q, y.tail(m), typename System::Multipliers(0), pieces);
    J.setZero();
    J.bottomRightCorner(m, m) = pieces.C;
    for (const Inertia& b : bodies_) {
      const auto& [x, p, u, omega] = b.at;
      const Vector4 quaternion = p < 0 ? Vector4(Vector4::Unit(0)) : Vector4(y.segment<4>(p));
      if (x >= 0) {
        const Matrix3 back = b.turned ? rotation_back(quaternion) : Matrix3(Matrix3::Identity());
        J.block(n, x, m, 3) = pieces.K.middleCols(u - n, 3) * back;
        J.block<3, 3>(x, u) = back.transpose();
        if (b.turned) {
          const Vector3 velocity = y.segment<3>(u);
          J.block<3, 4>(x, p) = turn_derivative(quaternion, velocity, turn(quaternion, velocity));
        }
      }
      if (p >= 0) {
        const Eigen::Matrix<double, 4, 3> Q = times_imaginary(quaternion);
        J.block(n, p, m, 4) =
            pieces.K.middleCols(omega - n, 3) * (2.0 / quaternion.squaredNorm() * Q.transpose());
        J.block<4, 4>(p, p) = 0.5 * imaginary_factor(y.segment<3>(omega));
        J.block<4, 3>(p, omega) = 0.5 * Q;
      }
    }
    for (const Inertia& b : bodies_) {
      if (b.at.u >= 0) J.middleRows<3>(b.at.u) *= -b.inverse_mass;
      if (b.at.omega >= 0)
        J.middleRows<3>(b.at.omega) = (-b.inverse_inertia * J.middleRows<3>(b.at.omega)).eval();
    }
  }

 private:
  struct Inertia {
    Places at;
    bool turned;  // its velocities are body-fixed
    double inverse_mass;
    Matrix3 inverse_inertia;
  };

  System system_;
  std::vector<Inertia> bodies_;
};

std::unique_ptr<const QuaternionScene::Functions> functions_of(const QuaternionScene::Data& model) {
  if (model->bodies.size() <= std::size_t(small_scene))
    return std::make_unique<const FunctionsOf<SmallScene>>(model);
  return std::make_unique<const FunctionsOf<Scene>>(model);
}

}  // namespace

QuaternionScene::QuaternionScene(const Data& model) : model_(model), functions_(functions_of(model)) {
  for (const Body<double>& body : model->bodies)
    if (const Eigen::Index p = places_of(*model, body).p; p >= 0) quaternions_.push_back(p);
}

QuaternionScene::Vector QuaternionScene::initial() const {
  Vector y(model_->q.size() + model_->v.size());
  y << model_->q, model_->v;
  return y;
}

QuaternionScene::Data quaternion_model(const AssembledScene& scene) {
  SceneDescription description = scene.scene;
  for (BodyDescription& body : description.bodies) body.kind = with_quaternion(body.kind);
  return make_scene_model<double>(description, scene.implied);
}

OwnState::OwnState(const AssembledScene& scene, QuaternionScene::Data model)
    : own_(make_scene_model<double>(scene.scene, scene.implied)), model_(std::move(model)) {}

Eigen::VectorXd OwnState::configuration(const Eigen::VectorXd& y) const {
  const auto q = unit_configuration<Eigen::VectorXd>(*model_, y);
  Eigen::VectorXd result(own_->q.size());
  for (std::size_t i = 0; i < own_->bodies.size(); ++i) {
    const Body<double>&own = own_->bodies[i], &body = model_->bodies[i];
    if (own.kind == body.kind) {
      result.segment(own.q, own.coordinates()) = q.segment(body.q, body.coordinates());
      continue;
    }
    RigidState<double> s;
    body.read_pose(q, s);
    visit_group<double>(own.kind, [&]<class G>(G) {
      auto place = result.segment<G::Stacked::RowsAtCompileTime>(own.q);
      if constexpr (G::dimension == 6)
        place = G::stacked(G::representative({s.x, s.R}));
      else if constexpr (!G::commutative)
        place = G::stacked(G::representative(s.R));
    });
  }
  return result;
}

}  // namespace liebench::outside
