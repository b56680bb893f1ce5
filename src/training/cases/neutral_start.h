#pragma once

#include <string>

#include "cases/prepare_case.h"
#include "geometry/pose.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::cases {

/// Initial poses of needle and transducer that do not reveal the plan. Frame P.
struct NeutralStart {
  static constexpr double kAway_mm = 60.0;  ///< Smallest distance of needle and transducer from the planned entry.
  /// Smallest distance between needle and transducer: hub and housing are thick.
  static constexpr double kApart_mm = 60.0;
  static constexpr double kAbove_mm = 20.0;  ///< Height of the tip above the skin.

  Pose X_PN;                ///< Above the skin, pointing at it along its normal.
  Pose X_PT;                ///< Pressed onto the skin, in a standard view of something else where there is one.
  double depth_mm = 160.0;  ///< Depth of the image, from the view.
  std::string note;         ///< Parts that could not be neutral and are as planned; empty: none.
};

/// Computes the start from the patient, and from the plan only the places to keep away from. The needle begins above
/// the skin nearest to the middle of the body's side on which the entry lies, at the organ's level; never from below.
/// There needle and transducer are kAway_mm from the entry, the whole shaft is free, and neither points at the target.
/// The same patient and plan give the same start. The start also keeps away from `X_PT_planned`. Errors: the views'
/// file.
Result<NeutralStart> find_neutral_start(const Case& the_case, const ultrasound::Transducer& transducer,
                                        const Pose& X_PT_planned);

}  // namespace trocar::cases
