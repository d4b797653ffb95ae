#pragma once

#include <type_traits>

namespace liebench {

namespace detail {

#ifdef LIEBENCH_SANITIZED  // by the build, in the preset asan
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

template <class Function>
[[gnu::noinline, gnu::flatten]] auto flattened(const Function& function) {
  return function();
}

}  // namespace detail

// function() with all that it calls inlined: in double, where small matrices in registers pay; elsewhere, and under
// AddressSanitizer, whose checks would make one function of it that takes minutes to compile, as it stands.
template <class T, class Function>
auto inlined(const Function& function) {
  if constexpr (std::is_same_v<T, double> && !detail::sanitized) return detail::flattened(function);
  return function();
}

}  // namespace liebench
