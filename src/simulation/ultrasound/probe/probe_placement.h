#pragma once

#include "anatomy/patient.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {

/// A transducer in a standard view.
struct ProbePlacement {
  Pose X_PT;
  ViewVisibility visibility;  ///< Visibility of the view's subject.
};

/// Places a transducer in a standard view: the middle of the face on the skin, y towards the target, the plane from the
/// view. Selects the position within view.search_mm that shows the most of the subject, with the least bone, gas and
/// lung on the path. If that shows less than kEnoughVisible, and view.search_mm > 0, the search continues over the skin
/// up to 60 degrees about the view's direction, with the plane turned by up to 60 degrees. The face is tilted by at
/// most 15 degrees in its plane and pressed in by at least view.pressed_mm, at most 15 mm, so that it touches along its
/// width. Errors: a patient without the target, no skin in any direction that the view permits.
Result<ProbePlacement> place_probe(const anatomy::VirtualPatient& patient, const ProbeView& view,
                                   const Transducer& transducer);

}  // namespace trocar::ultrasound
