#pragma once

#include <functional>
#include <optional>

#include "haptics/tick.h"
#include "lab/haptics/closed_motion.h"

namespace trocar::haptics {

/// The force model as a function from a motion of the tool to a wrench: poses are prescribed, nothing is moved by the
/// force. Energy of the motion (physics.md H8). The scene must not compensate the weight.
struct PassivityTrial {
  const ClosedMotion* before = nullptr;  ///< A motion that prepares the tissue (a channel); its work does not count.
  const ClosedMotion* motion = nullptr;
  double dt_s = 0.001;
};

/// One tick of a trial. Frame P.
struct PassivitySample {
  double time_s;
  Pose X_PTool;
  Wrench wrench_P;      ///< Of the force model, about S, before the device's limits.
  double by_force_mj;   ///< Energy given to the hand so far by the force,
  double by_torque_mj;  ///< and by the torque.
  const telemetry::TickSample& tick;
};

/// Energies are those given to the hand, in mJ; negative: taken from it.
struct PassivityOutcome {
  double end_mj = 0.0;     ///< At the end of the motion.
  double most_mj = 0.0;    ///< Largest since the start; at least 0.
  double most_s = 0.0;     ///< When.
  double device_mj = 0.0;  ///< Largest since the start of the wrench after the device's limits.
  double peak_force_n = 0.0;
  double stored_mj = 0.0;  ///< Largest energy taken from the hand.
  int ticks = 0;
  int limited_ticks = 0;  ///< Ticks in which the device's limits changed the wrench.
  int punctures = 0;
  bool is_finite = true;
  bool is_free_at_start = true;  ///< No force at the first and
  bool is_free_at_end = true;    ///< at the last pose.
};

/// Moves the tool along the motion, tick by tick.
PassivityOutcome run_passivity_trial(const HapticScene& scene, const PassivityTrial& trial,
                                     const std::function<void(const PassivitySample&)>& see = {});

/// Distance (mm) from the skin at `skin_P` along `axis_P` to where the device is when the skin gives way; empty if it
/// does not within `most_mm`.
std::optional<double> find_skin_puncture_mm(const HapticScene& scene, const Vec3& skin_P, const Vec3& axis_P,
                                            double most_mm);

/// Pose X_PTool that `tick` expects: the needle's, or for a face on the skin that of T, whose +y is the motion's +z.
Pose tool_of_motion(const HapticScene& scene, const Pose& X_PM) noexcept;

/// Switches off what takes energy from the hand: friction, cutting, viscosity, borders of the CT and the coupling's
/// damper. What remains is elastic, below the puncture forces, which stay as they are.
void remove_losses(anatomy::TissueTable& tissues, HapticOptions& options);
/// The layers that a motion of the elastic criterion may not open. On skin that never opens the tip slides without
/// friction.
enum class ClosedLayers { kNone, kAllButSkin, kAll };
void close_layers(anatomy::TissueTable& tissues, ClosedLayers closed);

}  // namespace trocar::haptics
