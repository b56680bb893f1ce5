#pragma once

#include <optional>

#include "haptics/contact/contact_face.h"
#include "haptics/patient_now.h"

namespace trocar::haptics {

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
