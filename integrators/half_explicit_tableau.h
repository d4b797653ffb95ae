#pragma once

#include <array>
#include <cstddef>

#include "integrators/fits.h"
#include "integrators/runge_kutta_tableau.h"

namespace liebench {

// Tableaus of half-explicit Runge-Kutta methods with an explicit first stage. Row i has the weights of the stage i; the
// row s those that the last stage is solved with. The row `end` is the new value, where the multipliers are sum_i d_i
// Lambda_i.
template <std::size_t s>
struct HalfExplicitTableau {
  static constexpr std::size_t stages = s;
  std::array<std::array<Fraction, s>, s + 1> a;
  std::array<Fraction, s + 1> c;
  std::size_t end;  // s or s - 1
  std::array<Fraction, s> d;
  ConvergenceOrders orders;

  // Row s + 1: d.
  constexpr const std::array<Fraction, s>& row(std::size_t i) const { return i == s + 1 ? d : a[i]; }
  // The last stage is the first of the next step.
  constexpr bool first_same_as_last() const { return end + 1 == s; }
};

// Three stages, order 3 [Arnold & Tumiotto 2024, half_explicit.F90].
inline constexpr HalfExplicitTableau<3> herk_three{
    .a = {{{}, {{{1, 2}}}, {{{2, 9}, {4, 9}}}, {{{1, 4}, {}, {3, 4}}}}},
    .c = {{{}, {1, 2}, {2, 3}, {1, 1}}},
    .end = 3,
    .d = {{{}, {-2, 1}, {3, 1}}},
    .orders = {3, 3, 2}};

// Five stages, order 4; c_6 = (3 - sqrt(3)) / 6 [ibidem].
inline constexpr HalfExplicitTableau<5> herk_four{
    .a = {{{},
           {{{1, 1}}},
           {{{3, 8}, {1, 8}}},
           {{{-1, 2}, {-1, 2}, {2, 1}}},
           {{{1, 6}, {}, {2, 3}, {1, 6}}},
           {{{18, 108, -1}, {}, {9, 27, -4}, {0, 108, -7}, {0, 18, 1}}}}},
    .c = {{{}, {1, 1}, {1, 2}, {1, 1}, {1, 1}, {3, 6, -1}}},
    .end = 4,
    .d = {{{}, {}, {}, {}, {1, 1}}},
    .orders = {4, 4, 3}};

// HEDOP5: the method of Dormand & Prince with a further row, order 5 [Arnold, BIT 38 (1998) 415-438].
inline constexpr HalfExplicitTableau<7> hedop_five{
    .a = {{{},
           {{{1, 5}}},
           {{{3, 40}, {9, 40}}},
           {{{44, 45}, {-56, 15}, {32, 9}}},
           {{{19372, 6561}, {-25360, 2187}, {64448, 6561}, {-212, 729}}},
           {{{9017, 3168}, {-355, 33}, {46732, 5247}, {49, 176}, {-5103, 18656}}},
           {{{35, 384}, {}, {500, 1113}, {125, 192}, {-2187, 6784}, {11, 84}}},
           {{{-18611506045861, 19738176307200},
             {59332529, 14479296},
             {-2509441598627, 893904224850},
             {2763523204159, 3289696051200},
             {-41262869588913, 116235927142400},
             {46310205821, 287848404480},
             {-3280, 75413}}}}},
    .c = {{{}, {1, 5}, {3, 10}, {4, 5}, {8, 9}, {1, 1}, {1, 1}, {19, 20}}},
    .end = 6,
    .d = {{{}, {}, {}, {}, {}, {}, {1, 1}}},
    .orders = {5, 5, 4}};

}  // namespace liebench
