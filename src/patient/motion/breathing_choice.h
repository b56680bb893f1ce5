#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "motion/breathing.h"

namespace trocar::motion {

/// Cranio-caudal motion of the liver (mm) in a deep breath: PMID 12885454, 24.4 ± 16.4.
inline constexpr double kDeepLiver_mm = 24.4;
/// In a quiet one [assumed]: kidneys move by 7.4–7.5 mm (doi 10.1186/1748-717X-8-248), which is 0.6–0.7 of what the
/// diaphragm does (PMC4539151).
inline constexpr double kQuietLiver_mm = 10.0;
/// Range of the largest drift of the liver (mm/s) while the breath is held: 5.6 mm in 24 s (PMC7055431).
inline constexpr double kMostDrift_mm_per_s = 5.6 / 24.0;

/// How somebody wants a patient to breathe, whoever the patient is.
struct BreathingChoice {
  double liver_mm = 0.0;  ///< How far the liver moves down in a breath; 0: the patient does not breathe. Range 0..40.
  double breaths_per_min = 14.0;           ///< Range 4..40. An adult at rest. [assumed]
  double irregularity = 0.15;              ///< MotionDrive::irregularity. [assumed]
  double cough_every_s = 0.0;              ///< MotionDrive::cough_every_s.
  double hold_limit_s = 20.0;              ///< MotionDrive::hold_limit_s.
  std::optional<std::uint32_t> seed = {};  ///< Of what varies; empty: whatever the caller takes.

  bool operator==(const BreathingChoice&) const = default;
};

/// "none", "quiet", "deep" or the liver's motion in mm, then what differs: "14,rate=18,irregularity=0.3,cough=40,
/// hold-limit=12,seed=3". Error (exit status 2): anything else, a number out of its range.
Result<BreathingChoice> parse_breathing(std::string_view text);
/// The same as a text; parse_breathing() restores it.
std::string to_text(const BreathingChoice& choice);

/// The drive that makes a patient with this model breathe so, from `begins_s` on. While the breath is held the liver
/// drifts up, by a share of kMostDrift_mm_per_s that depends on the seed. Error (exit status 2): deeper than the model
/// goes, irregular breaths included.
Result<MotionDrive> drive_of(const BreathingChoice& choice, const MotionModel& model, double begins_s = 0.0);

}  // namespace trocar::motion
