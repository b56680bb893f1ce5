#pragma once

#include "haptics/insertion/insertion.h"
#include "haptics/insertion/insertion_path.h"
#include "haptics/proxy/body_proxies.h"

namespace trocar::haptics {

/// State of the tip of paper B from one tick to the next. Fixed size.
struct ProxyNeedleState {
  Vec3 proxy_P = Vec3::Zero();    ///< x_p
  Vec3 proxy_A = Vec3::Zero();    ///< Outside the body: the place at rest of what was there.
  double along_mm = 0.0;          ///< x_p along the channel.
  Vec3 contact_P = Vec3::Zero();  ///< Point of the needle's first contact with the skin.
  bool is_on_skin = false;        ///< In contact with unpierced skin.
  SkinContact skin;
  double needle_mm = 0.0;        ///< Position of the virtual needle along the path, between the device and the proxy.
  double tissue_n_per_mm = 0.0;  ///< K at the last step; 0: none yet.
  std::uint8_t wall = kNoLayer;  ///< Wall in contact with the tip.
  double wall_mm = 0.0;          ///< Position of that wall on the path at rest.
  double wall_anchor_mm = 0.0;   ///< Position of the proxy under the load of the wall.
  double velocity_mm_per_s = 0.0;
  telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside;
};

/// Result of one step of the tip; forces act on the needle, in P.
struct ProxyNeedleStep {
  InsertionStep axial;              ///< Place, phase, events; its forces of paper A are zero.
  Vec3 tip_force_P = Vec3::Zero();  ///< Force on the tip.
};

/// Sets the proxy to the tip, so that the force is zero. Real-time safe.
void start_proxy_needle(ProxyNeedleState& state, const InsertionPath& path, const Vec3& tip_P,
                        const motion::PatientMotion& motion = kAtRest) noexcept;
/// Where the patient moves: takes the proxy along with the channel, whose line is now's (carry). Real-time safe.
void carry_proxy(ProxyNeedleState& state, const Channel& channel) noexcept;

/// One step of the tip proxy (physics.md B1 to B4). Before the skin puncture the proxy moves on the skin's surface,
/// afterwards on the path's line, to which the body proxies constrain it. `X_PN_ahead`: the pose one damping time ahead
/// of the device's. Bounded sub-steps of kProxyStep_mm. Real-time safe.
ProxyNeedleStep step_proxy_needle(ProxyNeedleState& state, InsertionPath& path, const PatientNow& now, const Pose& X_PN,
                                  const Pose& X_PN_ahead, double dt_s) noexcept;

inline constexpr double kProxyStep_mm = 0.25;  ///< Largest motion between two evaluations of the law.
inline constexpr int kMaxProxySteps = 32;      ///< Largest number of sub-steps per tick: 8 m/s at 1 kHz.

}  // namespace trocar::haptics
