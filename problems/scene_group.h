#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "groups/block_diagonal.h"
#include "groups/flattened.h"
#include "problems/scene_bodies.h"

namespace liebench {

// The product of the groups of all bodies of a scene; elements by their stacked representations. Valid as long as the bodies
// are.
template <class T, int most_bodies = Eigen::Dynamic>
class SceneGroup {
 public:
  using Scalar = T;
  static constexpr int dimension = Eigen::Dynamic;
  static constexpr int most = most_bodies == Eigen::Dynamic ? Eigen::Dynamic : 6 * most_bodies;
  static constexpr int most_coordinates = most_bodies == Eigen::Dynamic ? Eigen::Dynamic : 12 * most_bodies;
  using Element = Eigen::Matrix<T, Eigen::Dynamic, 1, 0, most_coordinates, 1>;
  using Tangent = Eigen::Matrix<T, Eigen::Dynamic, 1, 0, most, 1>;
  using TangentMatrix = BlockDiagonal<T>;
  using Bodies = std::vector<Body<T>>;

  explicit SceneGroup(const Bodies& bodies)
      : SceneGroup(bodies, bodies.empty() ? 0 : bodies.back().v + bodies.back().velocities()) {}
  SceneGroup(const Bodies& bodies, Eigen::Index size) : bodies_(&bodies), size_(size) {}
  template <class U>
  SceneGroup over() const {
    return *this;
  }

  Eigen::Index size() const { return size_; }
  Eigen::Index coordinates() const {
    return bodies_->empty() ? 0 : bodies_->back().q + bodies_->back().coordinates();
  }
  bool commutative() const {
    for (const Body<T>& body : *bodies_)
      if (body.rotates()) return false;
    return true;
  }

  Element identity() const {
    Element result(coordinates());
    each([&]<class G>(G, const Body<T>& b) { put<G>(result, b, G::identity()); });
    return result;
  }
  Element compose(const Element& p, const Element& q) const {
    return inlined<T>([&]() -> Element {
      Element result(coordinates());
      each([&]<class G>(G, const Body<T>& b) { put<G>(result, b, G::compose(at<G>(p, b), at<G>(q, b))); });
      return result;
    });
  }
  Element inverse(const Element& q) const {
    Element result(coordinates());
    each([&]<class G>(G, const Body<T>& b) { put<G>(result, b, G::inverse(at<G>(q, b))); });
    return result;
  }
  Element exp(const Tangent& v) const {
    return inlined<T>([&]() -> Element {
      Element result(coordinates());
      each([&]<class G>(G, const Body<T>& b) { put<G>(result, b, G::exp(part<G>(v, b))); });
      return result;
    });
  }
  // motion = exp(step), q = q_n o motion
  void put_motion(const Element& q_n, const Tangent& step, Element& motion, Element& q) const {
    inlined<T>([&] {
      motion.resize(q_n.size());
      q.resize(q_n.size());
      each([&]<class G>(G, const Body<T>& b) {
        const typename G::Element moved = G::exp(part<G>(step, b));
        put<G>(motion, b, moved);
        put<G>(q, b, G::compose(at<G>(q_n, b), moved));
      });
    });
  }
  Tangent log(const Element& q) const {
    Tangent result(size());
    each([&]<class G>(G, const Body<T>& b) { part<G>(result, b) = G::log(at<G>(q, b)); });
    return result;
  }
  Tangent commutator(const Tangent& v, const Tangent& w) const {
    return inlined<T>([&]() -> Tangent {
      Tangent result(size());
      each([&]<class G>(G, const Body<T>& b) {
        part<G>(result, b) = G::commutator(part<G>(v, b), part<G>(w, b));
      });
      return result;
    });
  }
  Tangent tangent_times(const Tangent& v, const Tangent& w) const {
    Tangent result(size());
    each([&]<class G>(G, const Body<T>& b) {
      part<G>(result, b) = G::tangent_times(part<G>(v, b), part<G>(w, b));
    });
    return result;
  }
  Tangent tangent_inverse_times(const Tangent& v, const Tangent& w) const {
    Tangent result(size());
    each([&]<class G>(G, const Body<T>& b) {
      part<G>(result, b) = G::tangent_inverse_times(part<G>(v, b), part<G>(w, b));
    });
    return result;
  }
  Tangent coadjoint(const Tangent& v, const Tangent& w) const {
    return pairwise(v, w, []<class G>(G, const auto& a, const auto& b) { return G::coadjoint(a, b); });
  }
  Tangent tangent_inverse_transposed_change(const Tangent& v, const Tangent& w) const {
    return pairwise(v, w, []<class G>(G, const auto& a, const auto& b) {
      return G::tangent_inverse_transposed_change(a, b);
    });
  }
  Tangent adjoint_transposed_change(const Tangent& v, const Tangent& w) const {
    return pairwise(
        v, w, []<class G>(G, const auto& a, const auto& b) { return G::adjoint_transposed_change(a, b); });
  }
  TangentMatrix ad(const Tangent& v) const {
    return blocks([&]<class G>(G, const Body<T>& b) { return G::ad(part<G>(v, b)); });
  }
  TangentMatrix tangent_inverse(const Tangent& v) const {
    return blocks([&]<class G>(G, const Body<T>& b) { return G::tangent_inverse(part<G>(v, b)); });
  }
  TangentMatrix tangent(const Tangent& v) const {
    return blocks([&]<class G>(G, const Body<T>& b) { return G::tangent(part<G>(v, b)); });
  }
  T rotation_angle(const Tangent& v) const {
    T largest(0.0);
    each([&]<class G>(G, const Body<T>& b) {
      const T angle = G::rotation_angle(part<G>(v, b));
      if (!(angle <= largest)) largest = angle;
    });
    return largest;
  }
  // The largest of all bodies'.
  T defect(const Element& q) const {
    T largest(0.0);
    each([&]<class G>(G, const Body<T>& b) {
      const T defect = G::defect(at<G>(q, b));
      if (!(defect <= largest)) largest = defect;
    });
    return largest;
  }
  // v with p = q o exp(v~), in double.
  Eigen::VectorXd separation(const Element& q, const Element& p) const {
    Eigen::VectorXd result(size());
    each([&]<class G>(G, const Body<T>& b) {
      result.segment<G::dimension>(b.v) = G::separation(at<G>(q, b), at<G>(p, b));
    });
    return result;
  }
  static const Element& stacked(const Element& q) { return q; }

 private:
  template <class Visitor>
  void each(const Visitor& visit) const {
    for (const Body<T>& body : *bodies_)
      visit_group<T>(body.kind, [&]<class G>(G group) { visit(group, body); });
  }
  // operation(G, v, w) of each body.
  template <class Operation>
  Tangent pairwise(const Tangent& v, const Tangent& w, const Operation& operation) const {
    return inlined<T>([&]() -> Tangent {
      Tangent result(size());
      each([&]<class G>(G group, const Body<T>& b) {
        part<G>(result, b) = operation(group, part<G>(v, b), part<G>(w, b));
      });
      return result;
    });
  }
  template <class Maker>
  TangentMatrix blocks(const Maker& make) const {
    std::vector<typename TangentMatrix::Block> result;
    result.reserve(bodies_->size());
    each([&]<class G>(G group, const Body<T>& b) { result.push_back(make(group, b)); });
    return TangentMatrix(std::move(result));
  }
  template <class G>
  static typename G::Element at(const Element& q, const Body<T>& b) {
    return G::unstacked(q.template segment<G::Stacked::RowsAtCompileTime>(b.q));
  }
  template <class G>
  static void put(Element& q, const Body<T>& b, const typename G::Element& value) {
    q.template segment<G::Stacked::RowsAtCompileTime>(b.q) = G::stacked(value);
  }
  template <class G, class Vectors>
  static auto part(Vectors& v, const Body<T>& b) {
    return v.template segment<G::dimension>(b.v);
  }

  const Bodies* bodies_;
  Eigen::Index size_;
};

}  // namespace liebench
