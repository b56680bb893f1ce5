#pragma once

#include <cstddef>
#include <string>

#include "anatomy/patient.h"
#include "attempt/guide/needle_view.h"
#include "cases/prepare_case.h"
#include "geometry/pose.h"
#include "metrics/metric.h"
#include "tasks/phases/phase.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// What advice depends on beside the needle's place.
struct GuideState {
  std::size_t cores = 0;               ///< Taken so far.
  bool is_loaded = true;               ///< The biopsy gun.
  const GunShot* last_shot = nullptr;  ///< Null: none.
  bool is_confirmed = false;           ///< What has to come back came.
  bool are_steps_done = false;         ///< All of the task's, which has some.
};

/// Advice to the trainee about the virtual needle and the planned path; at most one sentence, or empty. Priority: what
/// the tip is in or will harm on its way to the target, the target, depth, offset from the path, direction. Distances
/// are measured in the resting anatomy. After a shot the advice is how to get the next core; after the last one, or
/// when everything is done, "withdraw the needle" and "end the attempt".
std::string guide_puncture(const cases::Case& the_case, const telemetry::TickSample& sample,
                           const GuideState& state = {});

inline constexpr double kGuideAhead_mm = 12.0;  ///< Distance ahead of the tip that is checked.
inline constexpr double kGuideBeside_mm = 2.0;  ///< Offset from the path; smaller offsets give no advice. [assumed]
inline constexpr double kGuideTilt_deg = 2.0;   ///< [assumed]
inline constexpr double kGuideDepth_mm = 1.5;   ///< Tolerance of the depth at the target. [assumed]

/// Advice to the trainee about a transducer whose image has to show a target; one sentence. Priority: contact with the
/// skin, place on the skin, distance of the image plane from the target, edges of the image, what hides the target.
/// `X_PT` in P, the target in the anatomy at rest, `contact_n`: force on the skin.
std::string guide_transducer(const anatomy::VirtualPatient& patient, const motion::PatientMotion& motion,
                             const Vec3& target_A, const Pose& X_PT, double contact_n,
                             const metrics::ImagePlane& plane);
/// True for a step that the transducer does: it has to touch the skin or to show the target.
bool is_step_of_transducer(const tasks::Phase& phase);

inline constexpr double kGuideSteep_deg = 40.0;      ///< Target farther from the beam: the transducer moves. [assumed]
inline constexpr double kGuideBesidePlane_mm = 2.0;  ///< A target nearer to the plane is shown. [assumed]

}  // namespace trocar::attempt
