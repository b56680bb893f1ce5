#pragma once

#include <array>
#include <optional>

#include "geometry/vec.h"
#include "haptics/contact/contact_balance.h"
#include "haptics/contact/contact_face.h"
#include "haptics/haptic_scene.h"

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

/// What a fingertip feels at a place of the skin (docs/physics.md B10).
struct Palpation {
  double force_n = 0.0;
  double pressed_mm = 0.0;          ///< Indentation of the skin at that force.
  double stiffness_n_per_mm = 0.0;  ///< Slope of the force there: the hardness that a finger feels.
  /// Depth of rigid tissue (bone) under the middle of the fingertip, below the skin; empty: none within kColumn_mm.
  std::optional<double> bone_mm;
};

/// Force of a palpating finger. Range 1..15. [assumed]
inline constexpr double kPalpating_n = 5.0;

/// Presses a face of fingertip's shape `pressed_mm` into the skin at a point of it, along `inward_P` (unit): the sum of
/// the columns of tissue under its points, layers in series, as in contact.h. Friction and tilt do not act. The
/// scene is that of a finger (HapticOptions::tool). Real-time safe; 0 N for a press that is not positive.
Palpation press(const PatientNow& now, const Vec3& skin_P, const Vec3& inward_P, double pressed_mm) noexcept;
/// The same for a given force: the indentation is found to 0.01 mm, at most kColumn_mm.
Palpation palpate(const PatientNow& now, const Vec3& skin_P, const Vec3& inward_P,
                  double force_n = kPalpating_n) noexcept;

/// Hardness in classes for words and colours; limits assumed.
enum class Hardness { kSoft, kFirm, kHard };
Hardness hardness_of(const Palpation& palpation) noexcept;

inline constexpr double kFirm_n_per_mm = 0.9, kHard_n_per_mm = 1.6;  ///< At kPalpating_n. [assumed]

}  // namespace trocar::haptics
