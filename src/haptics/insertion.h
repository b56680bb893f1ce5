#pragma once

#include <array>
#include <cstdint>

#include "haptics/channel.h"
#include "haptics/haptic_scene.h"
#include "telemetry/tick_sample.h"

namespace trocar {

/// The needle in its insertion (paper A, section 4.1): what must be known from one tick to the next. Fixed size.
struct InsertionState {
  bool is_started = false;
  bool has_path = false;  ///< The skin is pierced: the needle keeps to channel's line.
  Channel channel;        ///< Of this insertion.
  ChannelMemory memory;   ///< Holes of past insertions.

  Vec3 device_tip_P = Vec3::Zero();  ///< Device tip at the last tick.
  double s_device_mm = 0.0;          ///< Device tip along the path at the last solution.
  double s_mm = 0.0;                 ///< Virtual needle's tip along the path.
  double rest_mm = 0.0;              ///< The same in the resting anatomy: at the surface while a layer is loaded.
  double velocity_mm_per_s = 0.0;
  double device_velocity_mm_per_s = 0.0;  ///< Axial, of the last step.
  double device_speed_mm_per_s = 0.0;     ///< Smoothed |axial velocity| of the device.
  double pending_s = 0.0;                 ///< Rest of the tick in which a layer gave way.

  Vec3 contact_P = Vec3::Zero();              ///< P: where the needle first touched the skin.
  Vec3 contact_to_puncture_P = Vec3::Zero();  ///< PX_p, zero before the skin gives way.

  std::uint8_t loading = kNoLayer;  ///< Layer under load.
  double surface_mm = 0.0;          ///< s of its resting surface.
  bool is_stuck = false;
  InsertionPhase phase = InsertionPhase::kOutside;
  std::array<double, kMaxTissues> inserted_mm{};  ///< Shaft length in each tissue.
  double travel_mm = 0.0;  ///< Way of the tip through the resting tissue, in and out: argument of the
                           ///< friction's fluctuation.
  std::uint8_t label = 0;  ///< At the tip.
};

/// What one step gives: the very values put into the laws, forces as resistances (positive pushes the needle out).
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
  std::uint8_t tissue = 0;
  InsertionPhase phase = InsertionPhase::kOutside;
  std::uint8_t punctured = kNoLayer;      ///< Layer that gave way in this step.
  std::array<std::uint8_t, 3> entered{};  ///< Labels that the tip entered, 0 = none.
  bool dropped_events = false;
  bool hit_solver_bound = false;
};

/// One step of the needle: device tip and unit axis in P, dt > 0. A layer that gives way within the step ends it there
/// (force = puncture force); the rest of the time is added to the next step. Real-time safe.
InsertionStep step_insertion(InsertionState& state, const HapticScene& scene, const Vec3& device_tip_P,
                             const Vec3& device_axis_P, double dt_s) noexcept;

}  // namespace trocar
