#pragma once

#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// Dry and viscous friction of the shaft along the path.
struct AxialFriction {
  double dry_n = 0.0;
  double viscous_ns_per_mm = 0.0;
};

/// Balance of the needle along its path between three elements: the device, which drives it through the coupling; the
/// friction of its shaft; and the tissue, which bears its tip (spring K to the proxy). Massless; all in mm along the
/// path.
struct NeedleDrive {
  CouplingParams coupling;
  AxialFriction friction;
  double ahead_mm = 0.0;   ///< Position of the device a damping time ahead.
  double before_mm = 0.0;  ///< Position of the needle at the last tick.
  double dt_s = 0.001;
  double bed_n = 0.0;         ///< Force with which the bed of the bent shaft pushes the needle out,
  double bed_n_per_mm = 0.0;  ///< and its growth over the step.
};
struct NeedleBalance {
  double needle_mm = 0.0;
  double on_shaft_n = 0.0;
  double on_tip_n = 0.0;
  double on_bed_n = 0.0;
  double tip_n_per_mm = 0.0;  ///< Decrease of on_tip_n per mm of proxy motion.
};
/// Closed form; at rest while dry friction exceeds the driving force.
NeedleBalance balance_needle(const NeedleDrive& drive, double tissue_n_per_mm, double proxy_mm) noexcept;

}  // namespace trocar::haptics
