#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// The task in one patient: its entry zone where `landmark_zone` puts it; of several possible targets the one in which
/// the patient's first path for the task ends: the finding that the referral describes. A rule that the patient cannot
/// serve changes nothing. Calling it again changes nothing.
Task fit_to_patient(Task task, const anatomy::VirtualPatient& patient);

/// True if a path of the patient is one for the task ("TASK: PLACE") and starts in its entry zone.
bool is_path_for(const Task& task, const anatomy::NeedlePath& path);

/// Rules of the task that cannot be judged in the patient, because it lacks a landmark or a structure; one line each.
std::vector<std::string> unserved_rules(const Task& task, const anatomy::VirtualPatient& patient);

/// nullptr: the patient has no such landmark.
const anatomy::Landmark* find_landmark(const anatomy::VirtualPatient& patient, std::string_view name) noexcept;

/// The point of the skin `distance_mm` from a point near it, measured over the skin along a direction of P; a negative
/// distance goes the other way. Empty: the skin ends.
std::optional<Vec3> walk_on_skin(const anatomy::VirtualPatient& patient, const Vec3& from_P, const Vec3& towards_P,
                                 double distance_mm);

}  // namespace trocar::tasks
