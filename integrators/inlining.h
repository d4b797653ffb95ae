#pragma once

#include <type_traits>

namespace liebench {

// Whether the kernel and the steps inline all that they call: in double, where small matrices in registers pay. Not under
// AddressSanitizer, whose checks would make one function of it that takes minutes to compile.
template <class T>
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool inlines_all = false;
#else
inline constexpr bool inlines_all = std::is_same_v<T, double>;
#endif

}  // namespace liebench
