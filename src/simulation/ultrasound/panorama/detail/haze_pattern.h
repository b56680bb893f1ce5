#pragma once

#include <vector>

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/point_spread.h"
#include "ultrasound/engine/detail/scan_plan.h"

namespace trocar::ultrasound::detail {

/// Patterns of a scan, line * samples values each (docs/physics.md U17).
struct HazePattern {
  /// Clutter: noise, spread as echoes are, with a mean power of 1 at each depth.
  std::vector<float> re, im;
  /// Phase of the panorama's echoes, of modulus 1: its gray values contain none, and echoes interfere with needles and
  /// with the clutter of the face.
  std::vector<float> phase_re, phase_im;
};

/// Uses the buffers of a frame and of its output, which are cleared again.
HazePattern make_haze_pattern(const ScanPlan& plan, FrameState& frame, SteeringRows& rows, BasebandFrame& out);

}  // namespace trocar::ultrasound::detail
