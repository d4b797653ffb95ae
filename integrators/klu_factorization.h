#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace liebench {

// LU factorizations of sparse matrices of one pattern by SuiteSparse's KLU (Davis & Palamadai Natarajan 2010). The ordering is found
// once; later matrices are factorized with the pivots of the one before, as long as these are good. Compiled into
// liebench::scenes, so that no header needs KLU.
class KluFactorization {
 public:
  KluFactorization();
  ~KluFactorization();
  KluFactorization(KluFactorization&&) noexcept;
  KluFactorization& operator=(KluFactorization&&) noexcept;

  // Of the n x n matrix whose column j has the entries values[begins[j]] to values[begins[j + 1] - 1], in rows that ascend; begins
  // has n + 1 places. False where it is singular. KLU takes no pointers to constants, but changes none of these.
  bool factorize(std::span<std::int32_t> begins, std::span<std::int32_t> rows, std::span<double> values);

  // There are no factors: nothing was factorized yet, or the last matrix was singular.
  bool empty() const;

  // These need factors.
  void solve(double* x) const;    // A x = b in place: n numbers b become x
  double flops() const;           // of the factorization
  std::uint64_t entries() const;  // of L and U

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace liebench
