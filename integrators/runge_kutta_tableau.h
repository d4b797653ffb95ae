#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

#include "groups/scalar.h"

// Tableaus of Runge-Kutta methods by exact fractions, so that all scalars have them to their own precision.

namespace liebench {

// (numerator + root_three sqrt(3)) / denominator
struct Fraction {
  std::int64_t numerator = 0;
  std::int64_t denominator = 1;
  std::int64_t root_three = 0;

  constexpr bool is_zero() const { return numerator == 0 && root_three == 0; }
  constexpr bool operator==(const Fraction&) const = default;
};

namespace detail {
template <class T>
inline const T square_root_of_three = sqrt(T(3.0));
}  // namespace detail

// Integers of a double's 53 bits.
template <class T>
T value_of(const Fraction& f) {
  if constexpr (ScalarTraits<T>::extended) {
    T numerator(double(f.numerator));
    if (f.root_three != 0) numerator += T(double(f.root_three)) * detail::square_root_of_three<T>;
    return numerator / T(double(f.denominator));
  } else {
    return T((double(f.numerator) + double(f.root_three) * std::numbers::sqrt3) / double(f.denominator));
  }
}

// a_ij below the diagonal, b_i and c_i; `order` of an ordinary differential equation.
template <std::size_t s>
struct ExplicitTableau {
  static constexpr std::size_t stages = s;
  std::array<std::array<Fraction, s>, s> a;
  std::array<Fraction, s> b, c;
  int order;

  // Row s: b.
  constexpr const std::array<Fraction, s>& row(std::size_t i) const { return i == s ? b : a[i]; }
};

// The classical method of Kutta 1901.
inline constexpr ExplicitTableau<4> classical_four{
    .a = {{{}, {{{1, 2}}}, {{{}, {1, 2}}}, {{{}, {}, {1, 1}}}}},
    .b = {{{1, 6}, {1, 3}, {1, 3}, {1, 6}}},
    .c = {{{}, {1, 2}, {1, 2}, {1, 1}}},
    .order = 4};

// Dormand & Prince 1980, the six stages of the solution of order 5.
inline constexpr ExplicitTableau<6> dormand_prince_five{
    .a = {{{},
           {{{1, 5}}},
           {{{3, 40}, {9, 40}}},
           {{{44, 45}, {-56, 15}, {32, 9}}},
           {{{19372, 6561}, {-25360, 2187}, {64448, 6561}, {-212, 729}}},
           {{{9017, 3168}, {-355, 33}, {46732, 5247}, {49, 176}, {-5103, 18656}}}}},
    .b = {{{35, 384}, {}, {500, 1113}, {125, 192}, {-2187, 6784}, {11, 84}}},
    .c = {{{}, {1, 5}, {3, 10}, {4, 5}, {8, 9}, {1, 1}}},
    .order = 5};

// The same with its embedded solution of order 4: the seventh stage is the step, and b the difference of both solutions' weights.
inline constexpr ExplicitTableau<7> dormand_prince_pair{
    .a = {{{},
           {{{1, 5}}},
           {{{3, 40}, {9, 40}}},
           {{{44, 45}, {-56, 15}, {32, 9}}},
           {{{19372, 6561}, {-25360, 2187}, {64448, 6561}, {-212, 729}}},
           {{{9017, 3168}, {-355, 33}, {46732, 5247}, {49, 176}, {-5103, 18656}}},
           {{{35, 384}, {}, {500, 1113}, {125, 192}, {-2187, 6784}, {11, 84}}}}},
    .b = {{{71, 57600}, {}, {-71, 16695}, {71, 1920}, {-17253, 339200}, {22, 525}, {-1, 40}}},
    .c = {{{}, {1, 5}, {3, 10}, {4, 5}, {8, 9}, {1, 1}, {1, 1}}},
    .order = 5};

// Butcher's method of order 6 with 7 stages [Butcher 1964, On Runge-Kutta processes of high order].
inline constexpr ExplicitTableau<7> butcher_six{
    .a = {{{},
           {{{1, 3}}},
           {{{}, {2, 3}}},
           {{{1, 12}, {1, 3}, {-1, 12}}},
           {{{-1, 16}, {9, 8}, {-3, 16}, {-3, 8}}},
           {{{}, {9, 8}, {-3, 8}, {-3, 4}, {1, 2}}},
           {{{9, 44}, {-9, 11}, {63, 44}, {18, 11}, {}, {-16, 11}}}}},
    .b = {{{11, 120}, {}, {27, 40}, {27, 40}, {-4, 15}, {-4, 15}, {11, 120}}},
    .c = {{{}, {1, 3}, {2, 3}, {1, 3}, {1, 2}, {1, 2}, {1, 1}}},
    .order = 6};

// sum_j w_j x_j over the first `count` weights of the row i of the tableau (row `stages`: b); what has the weight 0 is
// left out. Some weight is not 0.
template <const auto& tableau, std::size_t i, std::size_t count, class Vector, std::size_t n>
Vector combination(const std::array<Vector, n>& x) {
  using T = typename Vector::Scalar;
  constexpr auto weights = tableau.row(i);
  constexpr std::size_t first = [&] {
    std::size_t j = 0;
    while (weights[j].is_zero()) ++j;
    return j;
  }();
  static_assert(first < count);
  Vector sum = value_of<T>(weights[first]) * x[first];
  const auto add = [&]<std::size_t j>(std::integral_constant<std::size_t, j>) {
    if constexpr (j > first && !weights[j].is_zero()) sum += value_of<T>(weights[j]) * x[j];
  };
  [&]<std::size_t... j>(std::index_sequence<j...>) {
    (add(std::integral_constant<std::size_t, j>{}), ...);
  }
  (std::make_index_sequence<count>{});
  return sum;
}

// h sum_j w_j slope_j with all weights of the row.
template <const auto& tableau, std::size_t i, class T, class Slope, std::size_t n>
Slope weighted_sum(const T& h, const std::array<Slope, n>& slopes) {
  return Slope(h * combination<tableau, i, tableau.row(i).size()>(slopes));
}

}  // namespace liebench
