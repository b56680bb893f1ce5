#pragma once

#include <limits>

#include "haptics/haptic_scene.h"
#include "haptics/insertion/insertion_path.h"

namespace trocar::haptics {

/// The force balance of the virtual needle along its axis for one step (physics.md V1): resistance of the tissue
/// against the coupling to the device. The needle has no mass; its speed is (s - s_previous)/dt, so the step is
/// implicit. Monotone in s, hence one solution. All s in mm along the path, forces in N, resistance positive.
class AxialBalance {
 public:
  double s_previous_mm = 0.0;
  double s_device_mm = 0.0;
  double v_device_mm_per_s = 0.0;
  double dt_s = 0.001;
  stylus::CouplingParams coupling;
  LoadingLaw loading;
  double surface_mm = std::numeric_limits<double>::infinity();  ///< Resting surface of the layer ahead.
  double viscous_ns_per_mm = 0.0;                               ///< Sum of nu_i A_i over the inserted shaft.
  /// Where the patient moves: mean velocity of the tissue at the tip against that along the shaft.
  double drift_mm_per_s = 0.0;
  double noise_n = 0.0;  ///< Fluctuation of the friction in this step; never along the motion.
  double grows_to_mm_per_s = std::numeric_limits<double>::infinity();  ///< Viscous friction grows up to this speed.
  double dry_n = 0.0;         ///< Dry friction of the body proxies, against the motion.
  bool is_thinning = false;   ///< The viscous friction is that of the body proxies, less than linear (physics.md B6).
  double bed_n = 0.0;         ///< Force with which the bed of the bent shaft pushes the needle out.
  double bed_n_per_mm = 0.0;  ///< Its growth over the step.
  double stick_n = 0.0;       ///< Holding force of a needle at rest; it loads the tissue below.
  double cutting_n = 0.0;     ///< F_c of the tissue in front of the tip and of the layer that it presses on.
  double cut_to_mm = 0.0;     ///< Start of uncut tissue.
  const SoftColumn* below = nullptr;  ///< Tissue below the layer ahead, or what recoils; nullptr: rigid.
  bool is_yielding = false;           ///< The layer ahead presses that tissue in.
  double yielded_mm = 0.0;            ///< Depression of that tissue at the start of the step.
  double recoil_mm = 0.0;             ///< Depression that remains of the last puncture, at the start of the step.
  double gives_again_mm = 0.0;        ///< Above 0: that tissue follows the whole load again, up to this depression.

  double bed_at_n(double s_mm) const noexcept { return bed_n + bed_n_per_mm * (s_mm - s_previous_mm); }
  double velocity(double s_mm) const noexcept { return (s_mm - s_previous_mm) / dt_s; }
  double displacement(double s_mm) const noexcept { return s_mm > surface_mm ? s_mm - surface_mm : 0.0; }
  double prepuncture_n(double s_mm) const noexcept;
  double friction_n(double s_mm) const noexcept;
  /// The share of F_c that the layer ahead does not yet bear: the tip's resistance is the larger of both.
  double cutting_force_n(double s_mm) const noexcept;
  /// Depression of the tissue below at the end of the step; what remains of the last puncture's, which recoils no
  /// further than the present load permits.
  double yielding_mm(double s_mm) const noexcept;
  double recoiling_mm(double s_mm) const noexcept;
  double coupling_n(double s_mm) const noexcept;
  /// Force that holds a needle at rest at s_previous: what the coupling pushes beyond layers and bed, while it loads
  /// the tissue below, too.
  double holding_n() const noexcept;
  /// Resistance minus coupling; increases with s.
  double unbalance_n(double s_mm) const noexcept;

 private:
  /// Forces of the tissue at a place and speed.
  struct Resistance {
    double layer_n, friction_n, cutting_n, bed_n;
    double sum_n() const noexcept { return layer_n + friction_n + cutting_n + bed_n; }
  };
  Resistance resistance_at(double s_mm, double v) const noexcept;
  double friction_at(double v_tip) const noexcept;
  double recoiling_under(double load_n) const noexcept;
  double yielding_under(const Resistance& resistance) const noexcept;
  double coupling_under(double s_mm, double v, const Resistance& resistance) const noexcept;
};

struct AxialSolution {
  double s_mm = 0.0;
  bool hit_bound = false;  ///< The bounded iteration ended before it converged.
};

/// Finds the s at which resistance and coupling balance. Bounded, real-time safe.
AxialSolution solve(const AxialBalance& balance) noexcept;

}  // namespace trocar::haptics
