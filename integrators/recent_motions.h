#pragma once

#include <array>
#include <cstddef>

#include "problems/system.h"

namespace liebench {

// The motions of the last steps together, q_{n-j}^{-1} o q_n for j = 1, ..., count: each step is one product for each
// but the first.
template <MechanicalSystem S, int most>
class RecentMotions {
 public:
  RecentMotions(const S& system, int count) : group_(group_of(system)), count_(count) {
    motions_.fill(group_.identity());
  }

  // q_n^{-1} o q_{n+1}
  void push(const Configuration<S>& motion) {
    for (std::size_t j = std::size_t(count_); j > 1; --j)
      motions_[j - 1] = group_.compose(motions_[j - 2], motion);
    if (count_ > 0) motions_[0] = motion;
  }

  // Of the last j steps.
  const Configuration<S>& over(int j) const { return motions_[std::size_t(j - 1)]; }

 private:
  [[no_unique_address]] typename S::Group group_;
  int count_;
  std::array<Configuration<S>, std::size_t(most)> motions_;
};

}  // namespace liebench
