#pragma once

#include <array>

#include "haptics/contact/contact_column.h"
#include "haptics/contact/contact_face.h"
#include "haptics/haptic_scene.h"
#include "haptics/insertion/path_constraint.h"

namespace trocar::haptics {

/// What a tool on the skin carries from tick to tick. Fixed size, copyable.
struct ContactState {
  bool is_started = false;
  double engagement = 1.0;       ///< 0..1: share of the tissue's forces; below 1 after a start inside the body.
  Pose X_PT_device;              ///< Where the device had the tool.
  Pose X_PT;                     ///< The tool as it is shown: it does not pass through the skin.
  Vec3 offset_P = Vec3::Zero();  ///< Of the shown tool's origin from the device's.
  Vec3 tilt_P = Vec3::Zero();    ///< Rotation vector of the shown tool against the device's (rad).
  std::array<double, kMaxContactPoints> depth_mm{};      ///< Indentation under each point, >= 0.
  std::array<TissueColumn, kMaxContactPoints> column{};  ///< Under each point in contact, smoothed in time.
  std::array<Vec3, kMaxContactPoints> stretch_P{};  ///< Of the skin by friction: from where it is free to the point.
};

/// Inside this time a tool that started in the body is pressed out: no force step. [assumed] 0.2..2 s.
inline constexpr double kEngage_s = 0.5;

/// Time of the transition between two columns, to avoid a force step at a voxel border. [assumed] 0.005..0.03 s.
inline constexpr double kColumnBlend_s = 0.015;

struct ContactStep {
  Wrench wrench_P;  ///< On the tool, about its origin T, in P: the coupling's, in balance with the skin.
  int points_in_contact = 0;
  double depth_mm = 0.0;        ///< Deepest indentation of the skin.
  double normal_n = 0.0;        ///< Sum of the points' normal forces.
  double friction_n = 0.0;      ///< Sum of the points' friction forces.
  bool is_bound = false;        ///< A bounded loop ended early.
  bool started_inside = false;  ///< The tool was found in the body at the start.
  bool has_jumped = false;      ///< The device moved further than a hand can: started afresh where it is.
};

/// A tool of finite size on soft skin (physics.md B9, B10): every point in contact is carried by the column of tissue
/// under it, softer where the column is thick and soft, stiff where bone or a hard tumour lies shallow; friction on the
/// skin. Coupled to the device by the scene's coupling in all six degrees of freedom. `X_PT`: the device's tool.
/// dt > 0, finite pose. Real-time safe.
ContactStep step_contact(ContactState& state, const HapticScene& scene, const Pose& X_PT, double dt_s) noexcept;

}  // namespace trocar::haptics
