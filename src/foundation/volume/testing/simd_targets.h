#pragma once

#include <hwy/targets.h>

namespace trocar::volume::testing {

/// While it exists, all kernels run as on a processor with the baseline's instruction set only (SSE2 on x86), not with
/// the best one of this processor. Not for kernels that run in other threads at its beginning or end.
class BaselineSimd {
 public:
  BaselineSimd() { hwy::SetSupportedTargetsForTest(HWY_STATIC_TARGET); }
  ~BaselineSimd() { hwy::SetSupportedTargetsForTest(0); }
  BaselineSimd(const BaselineSimd&) = delete;
  BaselineSimd& operator=(const BaselineSimd&) = delete;
};

}  // namespace trocar::volume::testing
