#pragma once

#include <cstddef>
#include <string>

#include "cases/prepare_case.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// State of a biopsy gun.
struct GunState {
  std::size_t shots = 0;
  bool is_loaded = true;
};

/// Advice to the trainee about the virtual needle and the planned path; at most one sentence, or empty. Priority:
/// structures at risk ahead of the tip, depth, offset from the path, direction. Distances are measured in the resting
/// anatomy. After a shot the advice is how to get the next
/// core; after the last one "withdraw the needle".
std::string guide_puncture(const cases::Case& the_case, const telemetry::TickSample& sample, const GunState& gun = {});

inline constexpr double kGuideAhead_mm = 12.0;  ///< Distance ahead of the tip that is checked.
inline constexpr double kGuideBeside_mm = 2.0;  ///< Offset from the path; smaller offsets give no advice. [assumed]
inline constexpr double kGuideTilt_deg = 2.0;   ///< [assumed]
inline constexpr double kGuideDepth_mm = 1.5;   ///< Tolerance of the depth at the target. [assumed]

}  // namespace trocar::attempt
