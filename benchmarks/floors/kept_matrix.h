#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

// How long a factorization is kept and when an iteration ends: the rules of integrators/newton.h, whose comments give
// their reasons, as every floor follows them.

namespace liebench::floors {

enum class Next { iterate, done, factorize, fail };

struct KeptMatrix {
  bool factorized = false;
  double mass_scale = 0.0;
  double rate = 1.0;
  double spent = 0.0;
  int steps = 0;
  int last = 0;
  // What the comparison with the general steppers looks at.
  long iterations = 0;
  long factorizations = 0;

  bool wants_refresh() const { return !factorized || (steps > 0 && last * steps > spent); }

  void renewed(double new_mass_scale) {
    ++factorizations;
    mass_scale = new_mass_scale;
    rate = 1.0;
    spent = 2.0;
    steps = 0;
    last = 0;
  }

  // After a correction of the given size in units of round-off.
  Next judge(double size, int iteration, double& previous, bool fresh, bool& stalled) {
    const double seen = iteration > 1 ? std::max(size, 1.0) / previous : rate;
    if (size <= 0.05 || seen * size <= 0.05) {
      rate = fresh ? 1.0 : std::min(1.0, 2.0 * seen);
      return finished(iteration);
    }
    Next next = Next::iterate;
    if (iteration > 1 && seen > 0.5) {
      if (size <= 32.0) return finished(iteration);
      if (!fresh) {
        next = Next::factorize;
      } else if (size <= 1e5) {
        return finished(iteration);
      } else if (stalled && seen > 1.0) {
        return Next::fail;
      } else {
        stalled = true;
      }
    } else {
      stalled = false;
    }
    previous = size;
    return iteration < 60 ? next : Next::fail;
  }

 private:
  Next finished(int iteration) {
    spent += iteration;
    ++steps;
    last = iteration;
    iterations += iteration;
    return Next::done;
  }
};

// value / scale in units of round-off
inline double relative(double value, double scale) {
  return value / (std::numeric_limits<double>::epsilon() * scale + std::numeric_limits<double>::min());
}

}  // namespace liebench::floors
