#pragma once

#include <string_view>

namespace liebench {

// What factorizes a matrix whose size is known at run time: see PatternedMatrix.
enum class LinearSolver {
  dense_lu,  // LU with partial pivoting
  klu        // SuiteSparse's sparse LU (Davis & Palamadai Natarajan 2010)
};

constexpr std::string_view name(LinearSolver solver) {
  return solver == LinearSolver::dense_lu ? "dense_lu" : "klu";
}

}  // namespace liebench
