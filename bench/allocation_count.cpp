#include "bench/allocation_count.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include "core/testing/heap_memory.h"

namespace trocar::bench {
namespace {

std::atomic<bool> is_counting{false};
std::atomic<std::size_t> counted_allocations{0};

void* take(std::size_t size, std::size_t alignment) {
  if (is_counting.load(std::memory_order_relaxed)) counted_allocations.fetch_add(1, std::memory_order_relaxed);
  return testing::heap_memory(size, alignment);
}

}  // namespace

AllocationCount::AllocationCount() noexcept {
  counted_allocations = 0;
  is_counting = true;
}
AllocationCount::~AllocationCount() {
  is_counting = false;
}
std::size_t AllocationCount::count() const noexcept {
  return counted_allocations;
}

}  // namespace trocar::bench

// All forms that the standard library's own would provide: the address sanitizer's forms do not call ours.
void* operator new(std::size_t size) {
  return trocar::bench::take(size, 0);
}
void* operator new[](std::size_t size) {
  return trocar::bench::take(size, 0);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return trocar::bench::take(size, 0);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new[](std::size_t size, const std::nothrow_t& nothrow) noexcept {
  return operator new(size, nothrow);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return trocar::bench::take(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return trocar::bench::take(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
