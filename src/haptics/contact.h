#pragma once

#include <array>

#include "anatomy/patient.h"
#include "haptics/haptic_scene.h"
#include "haptics/path_constraint.h"

namespace trocar {

inline constexpr int kMaxContactPoints = 32;

/// The face of a tool that lies on the skin, as points with an area and an outward normal each, in the tool's frame T
/// (transducer: x lateral, y into the body, z elevation, origin at the array's centre; a finger: +y along the finger
/// out of its tip).
struct ContactFace {
  int count = 0;
  std::array<Vec3, kMaxContactPoints> point_T{};
  std::array<Vec3, kMaxContactPoints> normal_T{};  ///< Unit, out of the tool.
  std::array<double, kMaxContactPoints> area_mm2{};
  double friction_mu = 0.0;  ///< Against the skin.
};
/// Convex array: an arc of `radius_mm` over `width_mm`, `thickness_mm` in elevation. With gel: mu is small.
ContactFace make_transducer_face(double radius_mm = 60.0, double width_mm = 60.0, double thickness_mm = 14.0);
/// A fingertip: half a ball.
ContactFace make_finger_face(double radius_mm = 8.0);

struct ContactState {
  bool is_started = false;
  Pose X_PT;                                       ///< The tool as it is shown: it does not pass through the skin.
  std::array<Vec3, kMaxContactPoints> anchor_P{};  ///< Where each point sticks to the skin.
  std::array<bool, kMaxContactPoints> is_anchored{};
};

struct ContactStep {
  Wrench wrench_P;  ///< On the tool, about its origin T, in P.
  int points_in_contact = 0;
  double depth_mm = 0.0;  ///< Deepest indentation of the skin.
  bool is_bound = false;  ///< A bounded loop ended early.
};

/// A tool of finite size on soft skin (physics.md B9): every point in contact is carried by the column of tissue under
/// it, softer where the column is thick and soft, stiff where bone or a hard tumour lies shallow; friction on the skin.
/// Coupled to the device by the scene's coupling. `X_PT`: the device's tool. dt > 0. Real-time safe.
ContactStep step_contact(ContactState& state, const HapticScene& scene, const Pose& X_PT, double dt_s) noexcept;

/// Stiffness a unit of area (N/mm^3) of the tissue under a point of the skin, looking inwards: 1 / integral of dz/E
/// down to kColumn_mm or to bone. Real-time safe.
double column_stiffness_n_per_mm3(const HapticScene& scene, const Vec3& skin_point_P, const Vec3& inward_P) noexcept;
inline constexpr double kColumn_mm = 40.0;

}  // namespace trocar
