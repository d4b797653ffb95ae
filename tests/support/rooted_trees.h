#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "groups/extended.h"
#include "integrators/runge_kutta_tableau.h"

// The conditions of order of rooted trees [Hairer, Norsett & Wanner, Solving ODE I, II.2].

namespace liebench {

// A rooted tree by its subtrees, which are trees of the list at lower places.
struct Tree {
  std::vector<std::size_t> children;
  int order;
  double density;  // gamma
};

inline std::vector<Tree> trees_up_to(int order) {
  std::vector<Tree> trees{{{}, 1, 1.0}};
  for (int p = 2; p <= order; ++p) {
    const std::size_t known = trees.size();
    // Subtrees at falling places, so that each set of them comes once.
    std::vector<std::size_t> children;
    const std::function<void(int, std::size_t)> grow = [&](int left, std::size_t end) {
      if (left == 0) {
        double density = p;
        for (const std::size_t child : children) density *= trees[child].density;
        trees.push_back({children, p, density});
        return;
      }
      for (std::size_t child = 0; child < end; ++child) {
        if (trees[child].order > left) continue;
        children.push_back(child);
        grow(left - trees[child].order, child + 1);
        children.pop_back();
      }
    };
    grow(p - 1, known);
  }
  return trees;
}

// sum_i b_i Phi_i(tree) for each of the trees.
template <std::size_t s>
std::vector<Extended> elementary_weights(const ExplicitTableau<s>& tableau, const std::vector<Tree>& trees) {
  std::vector<std::array<Extended, s>> stage_weights;  // of each tree: sum_j a_ij Phi_j
  std::vector<Extended> weights;
  for (const Tree& tree : trees) {
    std::array<Extended, s> phi;
    phi.fill(Extended(1.0));
    for (const std::size_t child : tree.children)
      for (std::size_t i = 0; i < s; ++i) phi[i] *= stage_weights[child][i];
    Extended weight(0.0);
    auto& above = stage_weights.emplace_back();
    above.fill(Extended(0.0));
    for (std::size_t i = 0; i < s; ++i) {
      weight += value_of<Extended>(tableau.b[i]) * phi[i];
      for (std::size_t j = 0; j < i; ++j) above[i] += value_of<Extended>(tableau.a[i][j]) * phi[j];
    }
    weights.push_back(weight);
  }
  return weights;
}

template <std::size_t s>
void expect_order(const ExplicitTableau<s>& tableau, const char* name) {
  const std::vector<Tree> trees = trees_up_to(tableau.order + 1);
  const std::vector<Extended> weights = elementary_weights(tableau, trees);
  bool higher = true;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const double defect = std::abs(to_double(weights[i] - Extended(1.0) / trees[i].density));
    if (trees[i].order <= tableau.order)
      EXPECT_LE(defect, 1e-29) << name << ", tree " << i << " of order " << trees[i].order;
    else
      higher = higher && defect < 1e-29;
  }
  EXPECT_FALSE(higher) << name << " has a higher order than it says";
  for (std::size_t i = 0; i < s; ++i) {
    Extended c(0.0);
    for (std::size_t j = 0; j < i; ++j) c += value_of<Extended>(tableau.a[i][j]);
    EXPECT_LE(std::abs(to_double(c - value_of<Extended>(tableau.c[i]))), 1e-30) << name << ", stage " << i;
  }
}

}  // namespace liebench
