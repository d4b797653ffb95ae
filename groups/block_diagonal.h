#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace liebench {

// A block diagonal matrix of square blocks, one for each factor of a product of groups: ad(v), T(v) and what is made of them.
// Blocks of 3 and 6 rows are multiplied as matrices of fixed size: bit for bit what a group of that size computes.
template <class T>
class BlockDiagonal {
 public:
  using Block = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;

  BlockDiagonal() = default;
  explicit BlockDiagonal(std::vector<Block> blocks) : blocks_(std::move(blocks)) {}

  const std::vector<Block>& blocks() const { return blocks_; }
  const BlockDiagonal& eval() const { return *this; }
  template <int p>
  T lpNorm() const {
    static_assert(p == Eigen::Infinity, "the largest entry");
    T largest(0.0);
    for (const Block& block : blocks_) {
      const T entry = block.template lpNorm<Eigen::Infinity>();
      if (largest < entry) largest = entry;
    }
    return largest;
  }

  friend BlockDiagonal operator+(const BlockDiagonal& A, const BlockDiagonal& B) {
    return blockwise(A, B, [](const Block& a, const Block& b) { return Block(a + b); });
  }
  friend BlockDiagonal operator-(const BlockDiagonal& A, const BlockDiagonal& B) {
    return blockwise(A, B, [](const Block& a, const Block& b) { return Block(a - b); });
  }
  friend BlockDiagonal operator*(const BlockDiagonal& A, const BlockDiagonal& B) {
    return blockwise(A, B, product);
  }
  friend BlockDiagonal operator*(const T& factor, const BlockDiagonal& A) {
    BlockDiagonal result = A;
    for (Block& block : result.blocks_) block = factor * block;
    return result;
  }
  BlockDiagonal& operator+=(const BlockDiagonal& B) { return *this = *this + B; }
  friend Vector operator*(const BlockDiagonal& A, const Vector& v) {
    Vector result(v.size());
    Eigen::Index begin = 0;
    for (const Block& block : A.blocks_) {
      const Eigen::Index rows = block.rows();
      if (rows == 3)
        result.template segment<3>(begin) = fixed<3>(block) * v.template segment<3>(begin);
      else if (rows == 6)
        result.template segment<6>(begin) = fixed<6>(block) * v.template segment<6>(begin);
      else
        result.segment(begin, rows) = block.lazyProduct(v.segment(begin, rows));
      begin += rows;
    }
    return result;
  }

  friend BlockDiagonal identity_like(const BlockDiagonal& A) {
    BlockDiagonal result = A;
    for (Block& block : result.blocks_) block.setIdentity();
    return result;
  }
  friend BlockDiagonal zero_like(const BlockDiagonal& A) {
    BlockDiagonal result = A;
    for (Block& block : result.blocks_) block.setConstant(T(0.0));
    return result;
  }

 private:
  template <int n>
  static Eigen::Map<const Eigen::Matrix<T, n, n>> fixed(const Block& block) {
    return Eigen::Map<const Eigen::Matrix<T, n, n>>(block.data());
  }
  static Block product(const Block& a, const Block& b) {
    if (a.rows() == 3) return fixed<3>(a) * fixed<3>(b);
    if (a.rows() == 6) return fixed<6>(a) * fixed<6>(b);
    return a.lazyProduct(b);
  }
  template <class Operation>
  static BlockDiagonal blockwise(const BlockDiagonal& A, const BlockDiagonal& B, const Operation& operation) {
    BlockDiagonal result;
    result.blocks_.reserve(A.blocks_.size());
    for (std::size_t i = 0; i < A.blocks_.size(); ++i)
      result.blocks_.push_back(operation(A.blocks_[i], B.blocks_[i]));
    return result;
  }

  std::vector<Block> blocks_;
};

}  // namespace liebench
