#pragma once

#include "haptics/proxy/tip_law.h"

namespace trocar::haptics {

/// Proxy of the needle's tip (paper B, section 2.1, eqs. 1 to 5; physics.md B1 to B3): a point x_p tied to the tip x_t
/// by a spring and a damper. The proxy moves only as far as the tissue's thresholds permit.

/// Equation (1) for one step: present force of the spring between tip and proxy, and its decrease as the proxy moves
/// along the shaft (unit u) and across it. Implicit: force and stability do not depend on the tick rate.
struct TipSpring {
  Vec3 u_P = Vec3::UnitZ();
  Vec3 force_P = Vec3::Zero();  ///< Force on the tissue.
  double axial_n_per_mm = 1.0;
  double lateral_n_per_mm = 1.0;
  double dt_s = 0.001;
};

/// Spring and damper directly from the device's tip to the proxy, for the time before there is a path. `target_P` is
/// the tip's position a damping time (s) ahead; the proxy has moved by `moved` in this step.
TipSpring free_spring(double stiffness_n_per_mm, double damping_s, const Vec3& target_P, const Vec3& proxy_P,
                      const Vec3& moved, double dt_s) noexcept;

/// Part of a force `f` that the tissue does not bear: equations (3) and (4), each from the same x_p, for the share
/// `border` of the law, then (5) for the rest. Zero: the proxy stays. Exact projection: f minus the residual is the
/// nearest force that the tissue can bear. `resistance_n`: R of this step, R0 + c|v| of the motion so far.
Vec3 residual_force(const Vec3& f, const TipLaw& law, double resistance_n) noexcept;

/// Further motion of the proxy in this step under the law at its present position; `moved` is its motion so far.
Vec3 proxy_motion(const TipSpring& spring, const TipLaw& law, const Vec3& moved) noexcept;

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
