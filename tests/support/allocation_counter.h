#pragma once

// Counts allocations: operator new, and malloc and its kin, from which Eigen takes its dynamic matrices. For a program that
// links allocation_counter.cpp with the linker's --wrap (tests/CMakeLists.txt): what its objects and static libraries
// allocate is counted, wherever they were compiled; what a shared library allocates by malloc is not.

namespace liebench {

// Allocations of the whole program, all threads, so far.
unsigned long allocations();

// Those since its construction.
class AllocationCounter {
 public:
  unsigned long count() const { return allocations() - before_; }

 private:
  unsigned long before_ = allocations();
};

}  // namespace liebench
