#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/harness.h"
#include "ultrasound/engine/echo_engine.h"

namespace trocar::bench {

/// The round with the lowest median, and the largest allocation of any round.
struct ScanBest {
  Figures frame, engine, scanner;  ///< ms.
  Figures calibration;             ///< us: the fixed loop after each frame.
  double allocations_a_frame = 0.0;
  double cpu_ms_a_frame = 0.0;  ///< Of all threads, mean of the best round.
};

/// Renders pictures of 640x480 with a moving transducer: five rounds of 120 frames. `renewed_share`: of the scanlines.
ScanBest measure_scan(ultrasound::EchoEngine& engine, const Pose& X_PT, std::span<const ultrasound::NeedleEcho> needles,
                      double renewed_share);

/// Appends the frame rate as case `name`, and as NAME/frame, NAME/engine … its parts.
void append_scan(const std::string& name, const ScanBest& best, std::vector<CaseResult>& results);

}  // namespace trocar::bench
