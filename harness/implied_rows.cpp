#include "harness/implied_rows.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "groups/extended.h"

namespace liebench {

namespace {

using Sparse = Eigen::SparseMatrix<Extended>;
using Index = Sparse::StorageIndex;

struct GradientEntries {
  const SceneSystem<double>& system;
  std::vector<Eigen::Triplet<Extended, Index>> entries{};
  template <class Block>
  void gradient(Eigen::Index row, int body, const Block& B) {
    const Eigen::Index v = system.model().bodies[std::size_t(body)].v;
    for (Eigen::Index i = 0; i < B.rows(); ++i)
      for (Eigen::Index j = 0; j < B.cols(); ++j)
        if (B(i, j) != 0.0) entries.emplace_back(Index(row + i), Index(v + j), Extended(B(i, j)));
  }
};

// The upper triangle of B B^T, rows and columns in the order.
Sparse upper_gramian(const SceneSystem<double>& system, const Eigen::VectorXd& q,
                     const std::vector<Index>& order) {
  GradientEntries gradient{system};
  system.gradient(q, gradient);
  std::vector<Index> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[std::size_t(order[i])] = Index(i);
  for (auto& entry : gradient.entries) entry = {place[std::size_t(entry.row())], entry.col(), entry.value()};
  Sparse B(system.multipliers(), velocity_size(system));
  B.setFromTriplets(gradient.entries.begin(), gradient.entries.end());
  const Sparse product = B * Sparse(B.transpose());
  return product.triangularView<Eigen::Upper>();
}

// L D L^T = G of a positive semidefinite G, row after row (Davis 2005, "Algorithm 849: a concise sparse Cholesky factorization
// package"), which leaves out the rows whose pivot vanishes.
class Factorization {
 public:
  explicit Factorization(const Sparse& upper)
      : upper_(upper),
        n_(std::size_t(upper.rows())),
        parent_(n_, -1),
        visited_(n_, -1),
        entries_of_column_(n_, 0) {
    for (Index k = 0; k < Index(n_); ++k) {
      visited_[std::size_t(k)] = k;
      for (Sparse::InnerIterator entry(upper_, k); entry; ++entry)
        for (auto i = Index(entry.row()); visited_[std::size_t(i)] != k; i = parent_[std::size_t(i)]) {
          if (parent_[std::size_t(i)] < 0) parent_[std::size_t(i)] = k;
          // Each entry takes those above it in its column.
          operations_ += std::int64_t(entries_of_column_[std::size_t(i)]++);
          visited_[std::size_t(i)] = k;
        }
    }
  }
  // Multiplications and subtractions that vanishing() will take.
  std::int64_t operations() const { return operations_; }

  // Whether less than so much of a row's length is left, by the row.
  std::vector<bool> vanishing(double tolerance) {
    std::vector<std::size_t> begin(n_ + 1, 0);
    for (std::size_t i = 0; i < n_; ++i) begin[i + 1] = begin[i] + entries_of_column_[i];
    std::vector<std::size_t> end(begin.begin(), begin.end() - 1);
    std::vector<Index> row_of(begin.back());
    std::vector<Extended> L(begin.back()), pivots(n_, Extended(0.0)), y(n_, Extended(0.0));
    std::vector<bool> vanishes(n_, false);
    std::vector<Index> pattern, path;
    std::fill(visited_.begin(), visited_.end(), Index(-1));
    for (Index k = 0; k < Index(n_); ++k) {
      find_pattern(k, y, pattern, path);
      Extended pivot = y[std::size_t(k)];
      y[std::size_t(k)] = Extended(0.0);
      const Extended length_squared = pivot;
      // The last one found is the first to eliminate.
      for (auto place = pattern.rbegin(); place != pattern.rend(); ++place) {
        const auto i = std::size_t(*place);
        const Extended value = y[i];
        y[i] = Extended(0.0);
        if (vanishes[i]) continue;
        for (std::size_t p = begin[i]; p < end[i]; ++p) y[std::size_t(row_of[p])] -= L[p] * value;
        const Extended factor = value / pivots[i];
        pivot -= factor * value;
        row_of[end[i]] = k;
        L[end[i]++] = factor;
      }
      pivots[std::size_t(k)] = pivot;
      // Not "less than": a row of zeros vanishes, too.
      vanishes[std::size_t(k)] = !(pivot > Extended(tolerance * tolerance) * length_squared);
    }
    return vanishes;
  }

 private:
  // Scatters column k of the upper triangle into y; the columns of L that row k has entries in, each behind those that follow it
  // in the elimination.
  void find_pattern(Index k, std::vector<Extended>& y, std::vector<Index>& pattern,
                    std::vector<Index>& path) {
    pattern.clear();
    visited_[std::size_t(k)] = k;
    for (Sparse::InnerIterator entry(upper_, k); entry; ++entry) {
      y[std::size_t(entry.row())] = entry.value();
      path.clear();
      for (auto i = Index(entry.row()); visited_[std::size_t(i)] != k; i = parent_[std::size_t(i)]) {
        path.push_back(i);
        visited_[std::size_t(i)] = k;
      }
      pattern.insert(pattern.end(), path.rbegin(), path.rend());
    }
  }

  const Sparse& upper_;
  std::size_t n_;
  std::vector<Index> parent_;
  std::vector<Index> visited_;
  std::vector<std::size_t> entries_of_column_;
  std::int64_t operations_ = 0;
};

// Some ten seconds in 106 bits: more than a hundred times what a chain of 100,000 bodies takes in its own order.
constexpr std::int64_t most_operations = 1'000'000'000;

}  // namespace

// |pivot| = |what the rows before leave of the row|^2. In double round-off would hide what is below 1e-8 of a row; in 106 bits
// (u = 1e-32) it hides what is below 1e-16, which is what the entries of B are good for.
std::vector<bool> implied_rows(const SceneSystem<double>& system, const Eigen::VectorXd& q,
                               double tolerance) {
  std::vector<Index> order(std::size_t(system.multipliers()));
  std::iota(order.begin(), order.end(), Index(0));
  Sparse gramian = upper_gramian(system, q, order);
  if (Factorization(gramian).operations() > most_operations) {
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> place;
    Eigen::AMDOrdering<Index>()(gramian.selfadjointView<Eigen::Upper>(), place);
    order.assign(place.indices().data(), place.indices().data() + place.size());
    gramian = upper_gramian(system, q, order);
  }
  const std::vector<bool> vanishing = Factorization(gramian).vanishing(tolerance);
  std::vector<bool> implied(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) implied[std::size_t(order[i])] = vanishing[i];
  return implied;
}

}  // namespace liebench
