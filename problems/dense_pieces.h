#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "problems/system.h"

namespace liebench {

// The pieces that a system of many bodies gives to a Newton matrix (SceneSystem::linearize) as dense matrices: stiffness K, damping C,
// constraint gradient B and Z, D_q of B v at fixed v. For checks; steps take them one by one.
template <class S>
struct DensePieces {
  using Matrix = Eigen::MatrixXd;
  static constexpr bool wants_rate_gradient = true;
  const S& system;
  Matrix K, C, B, Z;

  explicit DensePieces(const S& s) : system(s) {
    const Eigen::Index m = velocity_size(s), l = multiplier_size(s);
    K = C = Matrix::Zero(m, m);
    B = Z = Matrix::Zero(l, m);
  }
  template <class Block>
  void stiffness(int i, int j, const Block& block) {
    add(K, place(i), place(j), block);
  }
  template <class Block>
  void damping(int i, int j, const Block& block) {
    add(C, place(i), place(j), block);
  }
  void turning_stiffness(int i, const Eigen::Matrix3d& block) { add(K, place(i) + 3, place(i) + 3, block); }
  void turning_damping(int i, const Eigen::Matrix3d& block) { add(C, place(i) + 3, place(i) + 3, block); }
  template <class Block>
  void gradient(Eigen::Index row, int j, const Block& block) {
    add(B, row, place(j), block);
  }
  template <class Block>
  void rate_gradient(Eigen::Index row, int j, const Block& block) {
    add(Z, row, place(j), block);
  }

  // M, which depends on nothing.
  Matrix mass() const {
    Matrix M = Matrix::Zero(K.rows(), K.cols());
    for (const auto& body : system.model().bodies) add(M, body.v, body.v, body.mass_matrix());
    return M;
  }

 private:
  Eigen::Index place(int body) const { return system.model().bodies[std::size_t(body)].v; }
  template <class Block>
  static void add(Matrix& M, Eigen::Index row, Eigen::Index column, const Block& block) {
    M.block(row, column, block.rows(), block.cols()) += block;
  }
};

}  // namespace liebench
