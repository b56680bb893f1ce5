#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

namespace trocar::testing {

/// Memory of the C library for a replaced operator new; throws std::bad_alloc if there is none.
inline void* heap_memory(std::size_t size, std::size_t alignment) {
  void* memory = nullptr;
  if (alignment <= alignof(std::max_align_t)) {
    memory = std::malloc(size == 0 ? 1 : size);
  } else if (::posix_memalign(&memory, alignment, size) != 0) {
    memory = nullptr;
  }
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace trocar::testing
