#pragma once

#include "haptics/insertion/insertion.h"
#include "haptics/insertion/insertion_path.h"
#include "haptics/proxy/body_proxies.h"

namespace trocar::haptics {

/// The tip of paper B from one tick to the next. Fixed size.
struct ProxyNeedleState {
  Vec3 proxy_P = Vec3::Zero();    ///< x_p
  Vec3 contact_P = Vec3::Zero();  ///< Where the needle first touched the skin.
  bool is_on_skin = false;        ///< In contact with unpierced skin.
  double needle_mm = 0.0;         ///< Virtual needle along the path: between the device and the proxy.
  double tissue_n_per_mm = 0.0;   ///< K at the last step; 0: none yet.
  std::uint8_t wall = kNoLayer;   ///< Wall in contact with the tip.
  double wall_mm = 0.0;           ///< Position of that wall on the path at rest.
  double wall_anchor_mm = 0.0;    ///< Position of the proxy under the load of the wall.
  double velocity_mm_per_s = 0.0;
  telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside;
};

/// One step of the tip, forces as the needle feels them in P.
struct ProxyNeedleStep {
  InsertionStep axial;              ///< Place, phase, events; its forces of paper A are zero.
  Vec3 tip_force_P = Vec3::Zero();  ///< On the tip.
};

/// Sets the proxy to the tip: zero force. Real-time safe.
void start_proxy_needle(ProxyNeedleState& state, const InsertionPath& path, const Vec3& tip_P) noexcept;

/// One step of the tip proxy (physics.md B1 to B4): before the skin gives way on the skin's surface, then on the path's
/// line, held there by the body proxies. `X_PN_ahead`: the pose a damping time ahead of the device's. Bounded sub-steps
/// of kProxyStep_mm. Real-time safe.
ProxyNeedleStep step_proxy_needle(ProxyNeedleState& state, InsertionPath& path, const HapticScene& scene,
                                  const Pose& X_PN, const Pose& X_PN_ahead, double dt_s) noexcept;

inline constexpr double kProxyStep_mm = 0.25;  ///< At most this far before the law is read again.
inline constexpr int kMaxProxySteps = 32;      ///< A tick: 8 m/s at 1 kHz.

}  // namespace trocar::haptics
