#pragma once

#include <vector>

#include "bench/harness.h"

/// What the benchmarks' files offer to registry.cpp, a line each.
namespace trocar::bench {

/// Slices and points of a volume, against vtkImageReslice.
Result<std::vector<CaseResult>> run_slice_benchmark();

}  // namespace trocar::bench
