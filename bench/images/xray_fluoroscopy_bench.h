#pragma once

#include <vector>

#include "bench/harness.h"

namespace trocar::bench {

/// Cases "fluoroscopy/…" of `trocar bench xray`: frames with a static C-arm (tools, contrast agent and noise change),
/// and with a moving one at each level of detail.
Result<std::vector<CaseResult>> fluoroscopy_cases();

}  // namespace trocar::bench
