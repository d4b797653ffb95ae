#pragma once

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <type_traits>

#include "problems/heavy_top.h"

// The list of all formulations of the heavy top, for typed tests.

namespace liebench {

// TypeParam::In<double>, TypeParam::In<Extended>
template <template <class> class System>
struct HeavyTopFormulation {
  template <class T>
  using In = System<T>;
};

using HeavyTopFormulations = std::tuple<  //
    HeavyTopFormulation<HeavyTopSO3>,     //
    HeavyTopFormulation<HeavyTopS3>,      //
    HeavyTopFormulation<HeavyTopR3xSO3>,  //
    HeavyTopFormulation<HeavyTopR3xS3>,   //
    HeavyTopFormulation<HeavyTopSE3>,     //
    HeavyTopFormulation<HeavyTopS3R3>,    //
    HeavyTopFormulation<HeavyTopUDQ>>;

namespace detail {

template <class... F>
::testing::Types<F...> as_types(std::tuple<F...>);
template <class F>
using IfConstrained =
    std::conditional_t<(F::template In<double>::constraints > 0), std::tuple<F>, std::tuple<>>;
template <class... F>
auto with_constraints(std::tuple<F...>) -> decltype(std::tuple_cat(IfConstrained<F>{}...));

}  // namespace detail

using AllHeavyTops = decltype(detail::as_types(HeavyTopFormulations{}));
using ConstrainedHeavyTops = decltype(detail::as_types(detail::with_constraints(HeavyTopFormulations{})));

// Names in the output of gtest: those of the formulations.
struct HeavyTopNames {
  template <class F>
  static std::string GetName(int) {
    return F::template In<double>::formulation;
  }
};

}  // namespace liebench
