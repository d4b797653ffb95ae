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

// What the Newton kernel did, counted where it happens. A stepper takes the type of its audit as a parameter:
// runs that are timed take NoAudit, which is empty and compiles to nothing.
struct NoAudit {
  void iteration() {}
  void residual() {}
  void jacobian() {}
  void factorization(FactorizationCause) {}
  void solve() {}
};

struct KernelAudit {
  std::uint64_t iterations = 0;  // of the Newton kernel
  std::uint64_t residuals = 0;
  std::uint64_t jacobians = 0;
  std::uint64_t factorizations = 0;
  std::uint64_t factorizations_slow = 0;   // those among them that slow convergence asked for
  std::uint64_t factorizations_start = 0;  // those of the starting procedure
  std::uint64_t solves = 0;

  void iteration() { ++iterations; }
  void residual() { ++residuals; }
  void jacobian() { ++jacobians; }
  void factorization(FactorizationCause cause) {
    ++factorizations;
    if (cause == FactorizationCause::slow_convergence) ++factorizations_slow;
    if (cause == FactorizationCause::start) ++factorizations_start;
  }
  void solve() { ++solves; }
};

}  // namespace liebench
