#pragma once

#include <string>

#include "cases/prepare_case.h"
#include "geometry/pose.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::cases {

/// Initial poses of needle and transducer that do not reveal the plan. Frame P.
struct NeutralStart {
  static constexpr double kAway_mm = 60.0;   ///< Of needle and transducer from the planned entry, at least; and
  static constexpr double kApart_mm = 60.0;  ///< from each other: hub and housing are thick.
  static constexpr double kAbove_mm = 20.0;  ///< Of the tip over the skin.

  Pose X_PN;                ///< Over the skin, straight at it along its normal.
  Pose X_PT;                ///< Pressed onto the skin, in a standard view of something else where there is one.
  double depth_mm = 160.0;  ///< Of the picture: the view's.
  std::string note;         ///< What could not be had, and is as planned; empty: nothing.
};

/// From the patient, and from the plan only what must be kept away from: the needle begins over the skin nearest to the
/// middle of the body's side that the entry is on, at the organ's level, where needle and transducer are kAway_mm from
/// the entry, the whole shaft is free and neither points at the target; never from below. The same patient and plan
/// give the same start. `X_PT_planned` is kept away from, too. Errors: the views' file.
Result<NeutralStart> find_neutral_start(const Case& the_case, const ultrasound::Transducer& transducer,
                                        const Pose& X_PT_planned);

}  // namespace trocar::cases
