#pragma once

// Include this header before any other that includes Eigen, and link allocation_counter.cpp.
//
// Eigen takes the memory of dynamic matrices from malloc, past operator new. Its own switch for tests,
// EIGEN_RUNTIME_NO_MALLOC, turns an allocation into a failed eigen_assert; this header counts those too, in
// builds with NDEBUG as well.

#ifdef EIGEN_CORE_H
#error "tests/support/allocation_counter.h must come before Eigen"
#endif

namespace liebench {

// Number of calls of operator new (all forms) in the whole program so far.
unsigned long operator_new_calls();

namespace detail {
// A failed eigen_assert: while an AllocationCounter lives, an allocation by Eigen.
void eigen_assertion_failed(const char* condition);
unsigned long eigen_assertions();
}  // namespace detail

}  // namespace liebench

#define EIGEN_RUNTIME_NO_MALLOC
#define eigen_assert(x) ((x) ? static_cast<void>(0) : ::liebench::detail::eigen_assertion_failed(#x))

#include <Eigen/Core>

namespace liebench {

// Counts the allocations between its construction and a call of count(): operator new, and Eigen's dynamic
// matrices. One at a time; of the whole program, all threads.
class AllocationCounter {
 public:
  AllocationCounter() : news_(operator_new_calls()), assertions_(detail::eigen_assertions()) {
    Eigen::internal::set_is_malloc_allowed(false);
  }
  ~AllocationCounter() { Eigen::internal::set_is_malloc_allowed(true); }
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  unsigned long count() const {
    return operator_new_calls() - news_ + detail::eigen_assertions() - assertions_;
  }

 private:
  unsigned long news_, assertions_;
};

}  // namespace liebench
