#pragma once

#include <Eigen/Core>
#include <random>
#include <utility>
#include <vector>

#include "groups/direct_product.h"
#include "groups/lie_group.h"
#include "groups/s3.h"
#include "groups/s3_r3.h"
#include "groups/se3.h"
#include "groups/so3.h"
#include "groups/unit_dual_quaternions.h"

// What the property suite (lie_group_properties.h) asks of a group beyond the concept.

namespace liebench {

// A group with delicate places specialises LieGroupExamples,
// most easily by inheriting from this and replacing one function.
template <LieGroup G>
struct DefaultLieGroupExamples {
  using T = typename G::Scalar;
  using Tangent = typename G::Tangent;
  using Element = typename G::Element;

  // Directions of tangent vectors that the suite draws from, of any positive length: the suite scales them so
  // that the rotation angle (where nothing rotates: the length) is what a test asks for. Here both signs of
  // each coordinate axis, and 12 random directions, the same in every run.
  static std::vector<Tangent> directions() {
    std::vector<Tangent> all;
    for (int i = 0; i < G::dimension; ++i)
      for (const double sign : {1.0, -1.0}) {
        Tangent e = Tangent::Constant(T(0.0));
        e(i) = T(sign);
        all.push_back(e);
      }
    std::mt19937 random(20080517u);
    for (int n = 0; n < 12; ++n) {
      Tangent v;
      for (int i = 0; i < G::dimension; ++i) v(i) = T(double(random()) / 2147483648.0 - 1.0);
      all.push_back(v);
    }
    return all;
  }

  // All representations of q, q itself first: a unit quaternion and its negative are one rotation.
  static std::vector<Element> representations(const Element& q) { return {q}; }

  // What exp(v~) and a o b stand for, by formulas of their own where Represented has another group law.
  using Represented = typename G::Represented;
  static typename Represented::Element represented_exp(const Tangent& v) { return Represented::exp(v); }
  static typename Represented::Element represented_product(const typename Represented::Element& a,
                                                           const typename Represented::Element& b) {
    return Represented::compose(a, b);
  }
};

template <LieGroup G>
struct LieGroupExamples : DefaultLieGroupExamples<G> {};

// Rotations: the suite's own directions, and those where Shepperd's rule changes its pivot (equal diagonal entries).
template <LieGroup G>
struct RotationExamples : DefaultLieGroupExamples<G> {
  using T = typename G::Scalar;
  static std::vector<Eigen::Matrix<T, 3, 1>> directions() {
    std::vector<Eigen::Matrix<T, 3, 1>> all;
    for (const double x : {-1.0, 0.0, 1.0})
      for (const double y : {-1.0, 0.0, 1.0})
        for (const double z : {-1.0, 0.0, 1.0})
          if (x != 0 || y != 0 || z != 0) all.emplace_back(T(x), T(y), T(z));
    for (const double small : {1e-3, 1e-9}) {
      all.emplace_back(T(1.0), T(small), T(-0.7 * small));
      all.emplace_back(T(-small), T(-1.0), T(0.3 * small));
      all.emplace_back(T(small), T(2 * small), T(1.0));
    }
    all.emplace_back(T(0.3), T(-1.7), T(0.9));
    all.emplace_back(T(-2.1), T(0.4), T(-0.2));
    return all;
  }
};

template <Scalar T>
struct LieGroupExamples<SO3<T>> : RotationExamples<SO3<T>> {};

template <Scalar T>
struct LieGroupExamples<S3<T>> : RotationExamples<S3<T>> {
  static std::vector<Quaternion<T>> representations(const Quaternion<T>& p) { return {p, -p}; }
};

template <LieGroup A, LieGroup B>
struct LieGroupExamples<DirectProduct<A, B>> : DefaultLieGroupExamples<DirectProduct<A, B>> {
  using Element = typename DirectProduct<A, B>::Element;
  static std::vector<Element> representations(const Element& q) {
    std::vector<Element> all;
    for (const auto& a : LieGroupExamples<A>::representations(q.first))
      for (const auto& b : LieGroupExamples<B>::representations(q.second)) all.emplace_back(a, b);
    return all;
  }
};

// Rigid motions (x, R), composed as (x1 + R1 x2, R1 R2): the products and exponentials of the 4 x 4 matrices
// [R x; 0 1].
template <LieGroup G>
struct RigidMotionExamples : DefaultLieGroupExamples<G> {
  using T = typename G::Scalar;
  using Tangent = typename G::Tangent;
  using Pose = typename G::Represented::Element;
  using Homogeneous = Eigen::Matrix<T, 4, 4>;

  // The suite's own directions, which have pure translations and pure rotations among them, and screws:
  // along the axis of rotation, across it and far away from it.
  static std::vector<Tangent> directions() {
    std::vector<Tangent> all = DefaultLieGroupExamples<G>::directions();
    const auto add = [&](double a, double b, double c, double x, double y, double z) {
      Tangent v;
      v << T(a), T(b), T(c), T(x), T(y), T(z);
      all.push_back(v);
    };
    add(0.6, -1.4, 2.2, 0.3, -0.7, 1.1);
    add(0.7, 0.3, 0.0, 0.3, -0.7, 1.1);
    add(-7.0, 3.0, 5.0, 1.0, 0.2, -0.4);
    return all;
  }

  static Pose represented_product(const Pose& a, const Pose& b) {
    return pose(homogeneous(a) * homogeneous(b));
  }

  // sum A^k / k!, A = [skew(Omega) U; 0 0], for |Omega| <= 4.
  static Pose represented_exp(const Tangent& v) {
    Homogeneous A = Homogeneous::Constant(T(0.0));
    A.template topLeftCorner<3, 3>() = skew(v.template tail<3>());
    A.template topRightCorner<3, 1>() = v.template head<3>();
    Homogeneous sum = Homogeneous::Identity(), term = Homogeneous::Identity();
    for (int k = 1; k <= 60; ++k) {
      term = Homogeneous(term * A) / T(double(k));
      sum += term;
    }
    return pose(sum);
  }

 private:
  static Homogeneous homogeneous(const Pose& q) {
    Homogeneous H = Homogeneous::Identity();
    H.template topLeftCorner<3, 3>() = q.second;
    H.template topRightCorner<3, 1>() = q.first;
    return H;
  }
  static Pose pose(const Homogeneous& H) {
    return {H.template topRightCorner<3, 1>(), H.template topLeftCorner<3, 3>()};
  }
};

template <Scalar T>
struct LieGroupExamples<SE3<T>> : RigidMotionExamples<SE3<T>> {};

template <Scalar T>
struct LieGroupExamples<S3R3<T>> : RigidMotionExamples<S3R3<T>> {
  using Element = typename S3R3<T>::Element;
  static std::vector<Element> representations(const Element& q) { return {q, {q.first, -q.second}}; }
};

template <Scalar T>
struct LieGroupExamples<UnitDualQuaternions<T>> : RigidMotionExamples<UnitDualQuaternions<T>> {
  using Element = typename UnitDualQuaternions<T>::Element;
  static std::vector<Element> representations(const Element& q) { return {q, -q}; }
};

}  // namespace liebench
