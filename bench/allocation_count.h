#pragma once

#include <cstddef>

namespace trocar::bench {

/// Counts what all threads take with operator new while one lives; the program that links this counts in its own
/// operator new, at the price of a look at a flag.
class AllocationCount {
 public:
  AllocationCount() noexcept;
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;

  std::size_t count() const noexcept;
};

}  // namespace trocar::bench
