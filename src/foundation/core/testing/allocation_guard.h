#pragma once

#include <cstddef>

namespace trocar::testing {

/// Counts the allocations and frees of this thread during the lifetime of this object. Include allocation_guard.inc.h
/// once in a test program's translation unit (it replaces operator new and delete there):
///   AllocationGuard guard; tick(...); EXPECT_EQ(guard.count(), 0u);
class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  /// Allocations plus frees on this thread since construction.
  std::size_t count() const noexcept;

 private:
  std::size_t start_;
};

}  // namespace trocar::testing
