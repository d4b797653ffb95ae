#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>

namespace liebench {

// reserve() of a vector or a string, in large pages where the system has them: of a hundred megabytes the kernel makes 25,000
// small pages one by one, which takes longer than all that is then written into them.
template <class Container>
void reserve_in_large_pages(Container& container, std::size_t count) {
  container.reserve(count);
  constexpr std::uintptr_t page = 4096;
  const auto begin = (reinterpret_cast<std::uintptr_t>(container.data()) + page - 1) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(container.data() + container.capacity()) / page * page;
  // Advice: where it is not taken nothing is lost.
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace liebench
