#pragma once

#include <array>
#include <cstdint>

#include "haptics/haptic_scene.h"
#include "haptics/insertion/insertion_path.h"
#include "haptics/proxy/body_proxies.h"
#include "telemetry/tick_sample.h"

namespace trocar::haptics {

/// State of an insertion from one tick to the next (paper A, section 4.1). Fixed size.
struct InsertionState {
  Vec3 device_tip_P = Vec3::Zero();  ///< Device tip at the last tick.
  Vec3 device_tip_A = Vec3::Zero();  ///< The tissue that was there, at rest.
  double s_device_mm = 0.0;          ///< Device tip along the path at the last solution.
  double s_mm = 0.0;                 ///< Virtual needle's tip along the path.
  double velocity_mm_per_s = 0.0;
  double device_velocity_mm_per_s = 0.0;  ///< Axial velocity in the last step.
  double device_speed_mm_per_s = 0.0;     ///< Smoothed |axial velocity| of the device.
  double pending_s = 0.0;                 ///< Remaining time of the tick in which a layer was punctured.

  Vec3 contact_P = Vec3::Zero();  ///< P: where the needle first touched the skin.

  std::uint8_t loading = kNoLayer;  ///< Layer under load.
  double surface_mm = 0.0;          ///< s of its resting surface.
  SkinContact skin;                 ///< Before the skin puncture: s is along skin.way_P, from skin.anchor_P.
  double front_n = 0.0;             ///< Cutting force of the tissue in front of it.
  bool is_front_proxy = false;      ///< That force is the tip proxy's (combined model).
  double pressed_to_mm = 0.0;       ///< Deepest s under the load of layers: the tissue in front is cut so far.
  SoftColumn below;                 ///< Tissue that gives way or recoils.
  bool is_yielding = false;         ///< The layer under load presses that tissue in.
  double yielded_mm = 0.0;          ///< Depression of that tissue: the device is that much further along the path.
  double recoil_mm = 0.0;           ///< What remains of it since the last puncture.
  double gives_again_mm = 0.0;      ///< After a placement: it follows the load again, up to this depression.
  bool is_stuck = false;
  telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside;
};

/// Result of one step: the inputs of the force laws, and forces as resistances (positive pushes the needle out).
struct InsertionStep {
  Vec3 tip_P = Vec3::Zero();
  Vec3 axis_P = Vec3::UnitZ();
  double velocity_mm_per_s = 0.0;
  double depth_mm = 0.0;
  double displacement_mm = 0.0;  ///< x of the layer under load.
  double prepuncture_n = 0.0;
  double friction_n = 0.0;
  double cutting_n = 0.0;
  double stick_n = 0.0;
  double bed_n = 0.0;  ///< Of the bed of the bent shaft (physics.md B7).
  /// Combined model: force of the tip proxy in tissue that no layer or cutting force describes.
  double tip_proxy_n = 0.0;
  double body_axial_n = 0.0;  ///< Combined model: friction of the body proxies, in place of friction_n.
  std::uint8_t tissue = 0;
  telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside;
  std::uint8_t punctured = kNoLayer;  ///< Layer punctured in this step.
  EnteredLabels entered;
  bool hit_solver_bound = false;
  /// The tip presses unpierced skin: prepuncture_n is along the contact's way (physics.md V2).
  bool is_on_skin = false;
};

/// Forces of the proxies of paper B along the path, instead of the friction of paper A (combined model; physics.md T2).
struct ProxyShare {
  ShaftResistance shaft;
  double tip_n = 0.0;  ///< Threshold of the tip in uncut tissue without parameters of paper A.
  double tip_viscous_ns_per_mm = 0.0;
};

/// Sets needle and device to the device's pose: zero force. Above 0, `pressed_mm` is how far the skin gives way again
/// under the load of an inserted needle (physics.md S1, P6). Real-time safe.
void start_insertion(InsertionState& state, const InsertionPath& path, const PatientNow& now, const Vec3& device_tip_P,
                     double pressed_mm = 0.0) noexcept;

/// One step of the needle: device tip and unit axis in P, dt > 0. A puncture within the step ends the step there (force
/// = puncture force); the rest of the time is added to the next step. `share`: nullptr for the insertion model alone.
/// Real-time safe.
InsertionStep step_insertion(InsertionState& state, InsertionPath& path, const PatientNow& now,
                             const Vec3& device_tip_P, const Vec3& device_axis_P, double dt_s,
                             const ProxyShare* share = nullptr) noexcept;

}  // namespace trocar::haptics
