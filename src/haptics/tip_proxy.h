#pragma once

#include "haptics/tip_law.h"

namespace trocar {

/// The proxy of the needle's tip (paper B, section 2.1, eqs. 1 to 5; physics.md B1 to B3): a point x_p tied to the tip
/// x_t by a spring and a damper, which moves only as far as the tissue's thresholds let it.

/// Spring between tip and proxy, for one step: along the shaft (unit u) and across it, where the shaft gives way, too.
/// Equation (1) with a damper; the step is implicit, so that neither force nor stability hang on the tick rate. Along
/// the shaft it is the coupling in series with the tissue: friction loads the coupling alone, the tip both.
struct ProxySpring {
  Vec3 u_P = Vec3::UnitZ();
  double coupling_n_per_mm = 1.0;
  double axial_n_per_mm = 1.0;  ///< At most the coupling's.
  double lateral_n_per_mm = 1.0;
  double damping_s = 0.004;  ///< Damping over stiffness.
  double dt_s = 0.001;
};

/// Dry and viscous friction of the shaft along u, which the same spring must overcome.
struct AxialFriction {
  double dry_n = 0.0;
  double viscous_ns_per_mm = 0.0;
};

/// What of a force `f` the tissue does not bear: equations (3) and (4), each from the same x_p, for the share `border`
/// of the law, then (5) for the rest. Zero: the proxy stays. Exact projection: f minus the residual is the nearest
/// force that the tissue can bear. `resistance_n`: R of this step, R0 + c|v| of the motion so far.
Vec3 residual_force(const Vec3& f, const TipLaw& law, double resistance_n) noexcept;

/// What the needle bears with the tip at `target_P` (a damping time ahead of the device) and the proxy at `proxy_P`,
/// having moved by `moved` in this step.
struct ProxyForce {
  double on_shaft_n = 0.0;       ///< Along u, by friction.
  Vec3 on_tip_P = Vec3::Zero();  ///< By the tissue at the tip.
};
ProxyForce proxy_force(const ProxySpring& spring, const AxialFriction& friction, const Vec3& target_P,
                       const Vec3& proxy_P, const Vec3& moved) noexcept;

/// How far the proxy moves on from here in this step under the law read here; `moved` is what it has moved already.
Vec3 proxy_motion(const ProxySpring& spring, const AxialFriction& friction, const TipLaw& law, const Vec3& target_P,
                  const Vec3& proxy_P, const Vec3& moved) noexcept;

}  // namespace trocar
