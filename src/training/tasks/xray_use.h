#pragma once

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

}  // namespace trocar::tasks
