#pragma once
// Replaces the global operator new and delete of the test program that includes it, in one translation unit only.

#include <cstdlib>
#include <new>

#include "core/testing/allocation_guard.h"
#include "core/testing/heap_memory.h"

namespace trocar::testing {

inline thread_local std::size_t allocation_events = 0;

AllocationGuard::AllocationGuard() noexcept : start_(allocation_events) {}
std::size_t AllocationGuard::count() const noexcept {
  return allocation_events - start_;
}

inline void* counted_allocation(std::size_t size, std::size_t alignment) {
  ++allocation_events;
  return heap_memory(size, alignment);
}

inline void* counted_allocation_or_none(std::size_t size) noexcept {
  try {
    return counted_allocation(size, 0);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

inline void counted_free(void* memory) noexcept {
  if (memory != nullptr) ++allocation_events;
  std::free(memory);
}

}  // namespace trocar::testing

void* operator new(std::size_t size) {
  return trocar::testing::counted_allocation(size, 0);
}
void* operator new[](std::size_t size) {
  return trocar::testing::counted_allocation(size, 0);
}
void* operator new(std::size_t size, std::align_val_t a) {
  return trocar::testing::counted_allocation(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return trocar::testing::counted_allocation(size, static_cast<std::size_t>(a));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return trocar::testing::counted_allocation_or_none(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return trocar::testing::counted_allocation_or_none(size);
}
void operator delete(void* memory) noexcept {
  trocar::testing::counted_free(memory);
}
void operator delete[](void* memory) noexcept {
  trocar::testing::counted_free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  trocar::testing::counted_free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  trocar::testing::counted_free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  trocar::testing::counted_free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  trocar::testing::counted_free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  trocar::testing::counted_free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  trocar::testing::counted_free(memory);
}
