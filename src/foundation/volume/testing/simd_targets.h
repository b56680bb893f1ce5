#pragma once

#include <hwy/targets.h>

namespace trocar::volume::testing {

/// During the lifetime of this object, all kernels use the baseline's instruction set only (SSE2 on x86), not the best
/// one of this processor. No kernel may run in another thread during construction or destruction.
class BaselineSimd {
 public:
  BaselineSimd() { hwy::SetSupportedTargetsForTest(HWY_STATIC_TARGET); }
  ~BaselineSimd() { hwy::SetSupportedTargetsForTest(0); }
  BaselineSimd(const BaselineSimd&) = delete;
  BaselineSimd& operator=(const BaselineSimd&) = delete;
};

}  // namespace trocar::volume::testing
