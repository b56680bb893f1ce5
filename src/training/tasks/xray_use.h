#pragma once

#include <span>
#include <vector>

#include "geometry/vec.h"

namespace trocar::tasks {

/// State of the fluoroscope at one moment of an attempt, with the contrast agent and the dose up to then. Frame P.
struct XrayUse {
  double time_s = 0.0;  ///< Session time.
  double lao_deg = 0.0, cranial_deg = 0.0;
  Vec3 isocentre_P = Vec3::Zero();
  double field_mm = 0.0;
  bool is_beam_on = false;
  double contrast_ml = 0.0;      ///< Injected.
  double beam_s = 0.0;           ///< Time with the beam on.
  double air_kerma_mgy = 0.0;    ///< At the reference point.
  double dose_area_gycm2 = 0.0;  ///< Air kerma times irradiated area.

  bool operator==(const XrayUse&) const = default;
};

/// Contrast agent that was injected without a pause.
struct ContrastInjection {
  double end_s = 0.0;     ///< Session time.
  double ml = 0.0;        ///< Of this injection.
  double total_ml = 0.0;  ///< Of all up to its end.
};
inline constexpr double kBetweenInjections_s = 0.5;  ///< A longer pause begins another injection. [assumed]
/// `uses`: of an attempt, by time.
std::vector<ContrastInjection> find_injections(std::span<const XrayUse> uses);

}  // namespace trocar::tasks
