#pragma once

#include <cstdint>

namespace liebench {

// Why a Newton matrix was factorized.
enum class FactorizationCause {
  start,  // a saddle point or mass matrix of the starting procedure
  first,
  refresh,
  slow_convergence
};

// What the Newton kernel and the starting procedures did, counted where it happens (evaluations of the system and of its group
// are counted by problems/audited_system.h). A stepper takes the type of its audit as a parameter: NoAudit is empty
// and compiles to nothing.
struct NoAudit {
  void iteration() {}
  void rejection() {}
  void factorization(FactorizationCause) {}
  void solve() {}
};

struct KernelAudit {
  std::uint64_t iterations = 0;  // of the Newton kernel
  std::uint64_t factorizations = 0;
  std::uint64_t factorizations_start = 0;  // of them, by their causes
  std::uint64_t factorizations_first = 0;
  std::uint64_t factorizations_refresh = 0;
  std::uint64_t factorizations_slow = 0;
  std::uint64_t solves = 0;
  std::uint64_t rejections = 0;  // of steps, by the control of the error

  void iteration() { ++iterations; }
  void rejection() { ++rejections; }
  void factorization(FactorizationCause cause) {
    ++factorizations;
    switch (cause) {
      case FactorizationCause::start:
        ++factorizations_start;
        break;
      case FactorizationCause::first:
        ++factorizations_first;
        break;
      case FactorizationCause::refresh:
        ++factorizations_refresh;
        break;
      case FactorizationCause::slow_convergence:
        ++factorizations_slow;
        break;
    }
  }
  void solve() { ++solves; }
};

}  // namespace liebench
