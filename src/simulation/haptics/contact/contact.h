#pragma once

#include <array>

#include "geometry/wrench.h"
#include "haptics/contact/contact_column.h"
#include "haptics/contact/contact_face.h"
#include "haptics/patient_now.h"

namespace trocar::haptics {

/// State of a tool on the skin from tick to tick. Fixed size, copyable.
struct ContactState {
  bool is_started = false;
  double engagement = 1.0;       ///< 0..1: share of the tissue's forces; below 1 after a start inside the body.
  Pose X_PT_device;              ///< Device's pose of the tool at the last tick.
  Pose X_PT;                     ///< Displayed pose of the tool; the tool does not pass through the skin.
  Vec3 offset_P = Vec3::Zero();  ///< Vector from the origin of the device's tool to the origin of the displayed tool.
  Vec3 tilt_P = Vec3::Zero();    ///< Rotation vector of the displayed tool against the device's (rad).
  std::array<double, kMaxContactPoints> depth_mm{};      ///< Indentation under each point, >= 0.
  std::array<TissueColumn, kMaxContactPoints> column{};  ///< Column under each point in contact, smoothed in time.
  /// Stretch of the skin by friction: from the point's free position to the point.
  std::array<Vec3, kMaxContactPoints> stretch_P{};
};

/// Time over which a tool that started in the body is pressed out, to avoid a force step. [assumed] 0.2..2 s.
inline constexpr double kEngage_s = 0.5;

/// Time of the transition between two columns, to avoid a force step at a voxel border. [assumed] 0.005..0.03 s.
inline constexpr double kColumnBlend_s = 0.015;

struct ContactStep {
  Wrench wrench_P;  ///< Wrench of the coupling, in balance with the skin: on the tool, about its origin T, in P.
  int points_in_contact = 0;
  double depth_mm = 0.0;        ///< Deepest indentation of the skin.
  double normal_n = 0.0;        ///< Sum of the points' normal forces.
  double friction_n = 0.0;      ///< Sum of the points' friction forces.
  bool is_bound = false;        ///< A bounded loop ended before it converged.
  bool started_inside = false;  ///< The tool was in the body at the start.
  bool has_jumped = false;  ///< The device moved further than a hand can; the contact restarted at the device's pose.
};

/// Steps a tool of finite size on soft skin (physics.md B9, B10). The column of tissue under a point carries each point
/// in contact. A column is softer where it is thick and soft, and stiff where bone or a hard tumour lies shallow.
/// Friction acts on the skin. The scene's coupling couples the tool to the device in all six degrees of freedom.
/// `X_PT`: the device's tool. dt > 0, finite pose. Real-time safe.
ContactStep step_contact(ContactState& state, const PatientNow& now, const Pose& X_PT, double dt_s) noexcept;

}  // namespace trocar::haptics
