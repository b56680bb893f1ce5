#pragma once

#include <string>

#include "anatomy/patient.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {

/// Visible share of a view's subject, and shares by the cause of invisibility. The sum is 1.
struct ViewVisibility {
  double visible = 0.0;
  double behind_bone = 0.0;
  double behind_gas = 0.0;  ///< Includes lung, and air where the sound leaves the body.
  double unscanned = 0.0;   ///< Beyond an end of the CT (scan_ends.h).
  double outside_picture = 0.0;
  double too_deep = 0.0;  ///< The echo is weaker than the receiver's noise.
};

/// A view shows its subject where at least this share is visible [assumed].
inline constexpr double kEnoughVisible = 0.5;

/// Measures the part of the view's target within 40 mm of the point that the view aims at, in the image plane: its
/// area, or the surface that faces the transducer where the target is bone, lung or gas (docs/physics.md U16). Errors:
/// as choose_view for a patient without the target.
Result<ViewVisibility> measure_visibility(const anatomy::VirtualPatient& patient, const ProbeView& view,
                                          const Transducer& transducer, const Pose& X_PT);

/// Text of the causes of invisibility, the largest first: "71 % behind bone, 9 % outside the CT". Shares below half a
/// percent are left out.
std::string hidden_causes(const ViewVisibility& visibility);

}  // namespace trocar::ultrasound
