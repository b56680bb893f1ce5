#pragma once

#include <optional>

#include "anatomy/patient.h"
#include "geometry/segment.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// Direction of the fibres that the task's bevel has to part, near a point: the line through the structure along which
/// they run (BevelRule::fibres), from the centres of its slices within 15 mm above and below. Unit, towards the head.
/// Empty: the task has no such rule, or the patient lacks the structure there.
std::optional<Vec3> find_fibres(const Task& task, const anatomy::VirtualPatient& patient, const Vec3& near_P);

/// Angle between the plane of the bevel and the fibres, seen along the needle, 0..90 degrees: 0 if the bevel's face
/// (+y of N) looks across the fibres and parts them, 90 if its edge cuts them. 0 if the needle runs along the fibres.
double bevel_to_fibres_deg(const Mat3& R_PN, const Vec3& fibres_P) noexcept;

/// Direction across the needle that the bevel's face has to look to; of the two the one more to the patient's left.
Vec3 bevel_across_fibres_P(const Vec3& axis_P, const Vec3& fibres_P) noexcept;

/// Direction that the bevel has to face on a planned path; empty: the task or the patient does not say.
std::optional<Vec3> planned_bevel_P(const Task& task, const anatomy::VirtualPatient& patient, const Segment& path_P);

/// Orientation of a needle along `axis_P` whose bevel faces `bevel_P` as far as the axis allows.
Mat3 needle_rotation(const Vec3& axis_P, const Vec3& bevel_P) noexcept;

}  // namespace trocar::tasks
