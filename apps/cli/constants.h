#pragma once

namespace trocar::cli {

inline constexpr double kMm2PerCm2 = 100.0;
inline constexpr double kMm3PerMl = 1000.0;

inline constexpr const char* kPostureHelp =
    "How the patient lies for the puncture: supine, prone, left-lateral, right-lateral, sitting; without it the first "
    "posture of the task with a path";

/// Of needles that are given by the pose of their tip.
inline constexpr double kNeedleLength_mm = 200.0;

}  // namespace trocar::cli
