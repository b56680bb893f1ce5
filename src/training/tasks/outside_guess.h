#pragma once

#include <optional>

#include "anatomy/patient.h"
#include "geometry/segment.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// What one makes of a puncture by sight and touch from outside, where no image shows the way.
struct OutsideGuess {
  Segment line_P{Vec3::Zero(), Vec3::Zero()};  ///< Entry and direction that the surface suggests; as long as the plan.
  double cover_mm = 0.0;  ///< Soft tissue over the bone that is felt: thick tissue hides it. Range 0..80.
};

/// Of a task with a landmark zone: into its middle, at right angles to the skin. Of a task by palpation: in the middle
/// of the body at the height of the planned entry, at right angles to the skin, as if the spine were straight. Empty:
/// an image shows the way, or the skin is not found.
std::optional<OutsideGuess> guess_from_outside(const Task& task, const anatomy::VirtualPatient& patient,
                                               const Segment& plan_P);

}  // namespace trocar::tasks
