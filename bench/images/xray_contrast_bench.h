#pragma once

#include <vector>

#include "bench/harness.h"

namespace trocar::bench {

/// Case "contrast/step" of `trocar bench xray`: contrast agent in the bile ducts of ptcd-1, one thread.
Result<std::vector<CaseResult>> contrast_cases(const Progress& progress);

}  // namespace trocar::bench
