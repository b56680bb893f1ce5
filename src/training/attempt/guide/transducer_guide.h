#pragma once

#include <string>

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "metrics/metric.h"
#include "tasks/phases/phase.h"

namespace trocar::attempt {

/// Advice to the trainee about a transducer whose image has to show a target; one sentence. Priority: contact with the
/// skin, place on the skin, distance of the image plane from the target, edges of the image, what hides the target.
/// `X_PT` and target in P, `contact_n`: force on the skin.
std::string guide_transducer(const anatomy::VirtualPatient& patient, const Vec3& target_P, const Pose& X_PT,
                             double contact_n, const metrics::ImagePlane& plane);
/// True for a step that the transducer does: it has to touch the skin or to show the target.
bool is_step_of_transducer(const tasks::Phase& phase);

inline constexpr double kGuideSteep_deg = 40.0;      ///< Target farther from the beam: the transducer moves. [assumed]
inline constexpr double kGuideBesidePlane_mm = 2.0;  ///< A target nearer to the plane is shown. [assumed]

}  // namespace trocar::attempt
