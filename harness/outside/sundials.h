#pragma once

#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_nvector.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

// The objects of SUNDIALS [Hindmarsh et al. 2005; Gardner et al. 2022], each released by its owner; a solver's own
// memory, too.

namespace liebench::outside {

struct Release {
  void operator()(SUNContext object) const { SUNContext_Free(&object); }
  void operator()(N_Vector object) const { N_VDestroy(object); }
  void operator()(SUNMatrix object) const { SUNMatDestroy(object); }
  void operator()(SUNLinearSolver object) const { SUNLinSolFree(object); }
  void operator()(SUNNonlinearSolver object) const { SUNNonlinSolFree(object); }
};
template <class Object>
using Owned = std::unique_ptr<std::remove_pointer_t<Object>, Release>;

template <void (*free)(void**)>
struct ReleaseMemory {
  void operator()(void* memory) const { free(&memory); }
};
template <void (*free)(void**)>
using OwnedMemory = std::unique_ptr<void, ReleaseMemory<free>>;

// Throws std::logic_error unless the call of `function` went well: none of those that prepare a solver depends on the
// problem.
inline void require(int flag, std::string_view function) {
  if (flag < 0) throw std::logic_error(fmt::format("{} of SUNDIALS ended with {}", function, flag));
}
template <class Pointer>
Pointer require(Pointer made, std::string_view function) {
  if (made == nullptr) throw std::logic_error(fmt::format("{} of SUNDIALS made nothing", function));
  return made;
}

inline Owned<SUNContext> new_context() {
  SUNContext context = nullptr;
  require(SUNContext_Create(nullptr, &context), "SUNContext_Create");
  return Owned<SUNContext>(context);
}

// The numbers of a vector, of a square matrix; `size` may be Eigen::Dynamic.
template <int size>
auto numbers_of(N_Vector v) {
  using Numbers = Eigen::Map<Eigen::Matrix<double, size, 1>>;
  if constexpr (size == Eigen::Dynamic)
    return Numbers(N_VGetArrayPointer(v), N_VGetLength(v));
  else
    return Numbers(N_VGetArrayPointer(v));
}
template <int size>
auto numbers_of(SUNMatrix A) {
  using Numbers = Eigen::Map<Eigen::Matrix<double, size, size>>;
  if constexpr (size == Eigen::Dynamic)
    return Numbers(SUNDenseMatrix_Data(A), SUNDenseMatrix_Rows(A), SUNDenseMatrix_Columns(A));
  else
    return Numbers(SUNDenseMatrix_Data(A));
}

template <int size>
Owned<N_Vector> new_vector(const Owned<SUNContext>& context, const Eigen::Matrix<double, size, 1>& numbers) {
  Owned<N_Vector> v(require(N_VNew_Serial(numbers.size(), context.get()), "N_VNew_Serial"));
  numbers_of<size>(v.get()) = numbers;
  return v;
}

// LU factorization of a dense matrix for the Newton iterations of a solver.
struct DenseSolver {
  Owned<SUNMatrix> matrix;
  Owned<SUNLinearSolver> solver;

  DenseSolver(const Owned<SUNContext>& context, const Owned<N_Vector>& v)
      : matrix(require(SUNDenseMatrix(N_VGetLength(v.get()), N_VGetLength(v.get()), context.get()),
                       "SUNDenseMatrix")),
        solver(require(SUNLinSol_Dense(v.get(), matrix.get(), context.get()), "SUNLinSol_Dense")) {}
};

// What a solver says in place of printing it. Warnings, whose code is positive, are left out.
class LastError {
 public:
  static void handler(int code, const char*, const char*, char* message, void* self) {
    if (code < 0) static_cast<LastError*>(self)->text_ = message;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// A statistic of a solver: `get(memory, &number)`.
template <class Memory>
std::uint64_t statistic(const Memory& memory, int (*get)(void*, long*)) {
  long number = 0;
  require(get(memory.get(), &number), "a statistic");
  return std::uint64_t(number);
}

}  // namespace liebench::outside
