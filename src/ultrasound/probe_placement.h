#pragma once

#include "anatomy/patient.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "ultrasound/probe_view.h"
#include "ultrasound/transducer.h"

namespace trocar {

/// Pose X_PT of a transducer in a standard view: the middle of the face on the skin, y towards the target, the plane as
/// the view says. Of the places within view.search_mm the one with the least bone, gas and lung on the way is taken;
/// the face is tilted by at most 15 degrees in its plane and pressed in by at least view.pressed_mm, at most 15 mm, so
/// that it touches along its width. Errors: a patient without the target, no skin on any way
/// out that the view allows.
Result<Pose> place_probe(const VirtualPatient& patient, const ProbeView& view, const Transducer& transducer);

}  // namespace trocar
