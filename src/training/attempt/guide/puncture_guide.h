#pragma once

#include <string>

#include "attempt/case/prepare_case.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// What a teacher beside the trainee would say now, of the felt needle against the planned path; in words, at most one
/// thing. Empty: nothing to say. By weight: what lies just ahead of the tip and must not be touched, depth, being
/// beside the path, direction. Distances are measured in the resting anatomy.
/// After the shot there is one thing left: to withdraw the needle.
std::string guide_puncture(const Case& the_case, const telemetry::TickSample& sample, bool has_fired = false);

inline constexpr double kGuideAhead_mm = 12.0;  ///< So far the guide looks ahead of the tip.
inline constexpr double kGuideBeside_mm = 2.0;  ///< Beside the path; less is not worth a word. [assumed]
inline constexpr double kGuideTilt_deg = 2.0;   ///< [assumed]
inline constexpr double kGuideDepth_mm = 1.5;   ///< At the target. [assumed]

}  // namespace trocar::attempt
