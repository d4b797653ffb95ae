#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "harness/scene_assembly.h"
#include "problems/scene_system.h"

namespace liebench::outside {

// A scene without constraints as an ordinary differential equation of y = (q, v): q the positions x and quaternions p of its
// bodies one after the other, whatever their groups are, and v the scene's velocities,
//
//   x' = u   (R(p) U where velocities are body-fixed, no x where a point is fixed),   p' = p (0, Omega) / 2,
//   M v' = -g(t, q, v)
//
// |p| stays what it is, and has no effect (scaled_rotation.h).
class QuaternionScene {
 public:
  static constexpr int size = Eigen::Dynamic;
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  // Of bodies with quaternions: quaternion_model().
  using Data = std::shared_ptr<const SceneModel<double>>;

  explicit QuaternionScene(const Data& model);

  Vector initial() const;
  // Where quaternions begin in y.
  std::span<const Eigen::Index> quaternions() const { return quaternions_; }

  void derivative(double t, Eigen::Ref<const Vector> y, Eigen::Ref<Vector> f) const {
    functions_->derivative(t, y, f);
  }
  // df/dy
  void jacobian(double t, Eigen::Ref<const Vector> y, Eigen::Ref<Matrix> J) const {
    functions_->jacobian(t, y, J);
  }

  // For a number of bodies that needs no heap, and for any.
  class Functions {
   public:
    virtual ~Functions() = default;
    virtual void derivative(double t, Eigen::Ref<const Vector> y, Eigen::Ref<Vector> f) const = 0;
    virtual void jacobian(double t, Eigen::Ref<const Vector> y, Eigen::Ref<Matrix> J) const = 0;
  };

 private:
  Data model_;
  std::vector<Eigen::Index> quaternions_;
  std::unique_ptr<const Functions> functions_;
};

// The scene with unit quaternions in place of rotation matrices and dual quaternions; velocities are the same.
QuaternionScene::Data quaternion_model(const AssembledScene& scene);

// Of y the element of the scene's own group, stacked, and the velocities.
class OwnState {
 public:
  // `model`: quaternion_model(scene)
  OwnState(const AssembledScene& scene, QuaternionScene::Data model);

  Eigen::VectorXd configuration(const Eigen::VectorXd& y) const;
  Eigen::VectorXd velocity(const Eigen::VectorXd& y) const { return y.tail(model_->v.size()); }

 private:
  std::shared_ptr<const SceneModel<double>> own_, model_;
};

}  // namespace liebench::outside
