#pragma once

#include <cstddef>

namespace trocar::bench {

/// Counts the allocations of all threads with operator new during the lifetime of an object. The program that links
/// this file replaces operator new; outside of that lifetime, the cost is one test of a flag.
class AllocationCount {
 public:
  AllocationCount() noexcept;
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;

  std::size_t count() const noexcept;
};

}  // namespace trocar::bench
