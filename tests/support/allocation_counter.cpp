#include "tests/support/allocation_counter.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

std::atomic<unsigned long> news{0};
std::atomic<unsigned long> assertions{0};

void* allocate(std::size_t size) {
  ++news;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

void* allocate(std::size_t size, std::align_val_t alignment) {
  ++news;
  // aligned_alloc asks for a multiple of the alignment.
  const auto unit = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) return memory;
  throw std::bad_alloc();
}

}  // namespace

namespace liebench {

unsigned long operator_new_calls() {
  return news;
}

namespace detail {

void eigen_assertion_failed(const char* condition) {
  // Every other failed assertion is a programmer's error, as ever.
  if (std::strstr(condition, "is_malloc_allowed") == nullptr) {
    std::fprintf(stderr, "Eigen assertion failed: %s\n", condition);
    std::abort();
  }
  ++assertions;
}

unsigned long eigen_assertions() {
  return assertions;
}

}  // namespace detail
}  // namespace liebench

// The replaceable forms; the nothrow and array forms of the standard library call these.
void* operator new(std::size_t size) {
  return allocate(size);
}
void* operator new[](std::size_t size) {
  return allocate(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, alignment);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, alignment);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
