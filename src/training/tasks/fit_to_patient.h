#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/shapes.h"
#include "tasks/needle.h"
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

/// Postures in which paths are sought, in this order: the one that is chosen (Task::posture) alone; else those of the
/// task, the patient's own first if it is one of them; the patient's own where the task names none.
std::vector<anatomy::Posture> postures_to_try(const Task& task, const anatomy::VirtualPatient& patient);

/// The posture of an attempt: the first of them.
anatomy::Posture posture_of(const Task& task, const anatomy::VirtualPatient& patient);

/// Names of the needles with which a task may be done: its own, and `Task::needles` or, without them, all of the same
/// use.
std::vector<std::string> allowed_needles(const Task& task, const std::vector<Needle>& all);

/// Role of each label of a patient in a task.
class TaskLabels {
 public:
  TaskLabels(const Task& task, const anatomy::VirtualPatient& patient);

  enum class Part : std::uint8_t { kOther, kTarget, kOrgan, kVessel };
  Part part(std::uint8_t label_id) const noexcept { return parts_[label_id]; }
  /// The risk structure that a label belongs to, nullptr for none.
  const RiskStructure* risk(std::uint8_t label_id) const noexcept { return risks_[label_id]; }
  /// What a needle does to it at worst.
  Harm harm(std::uint8_t label_id) const noexcept { return harms_[label_id]; }
  bool is_bone(std::uint8_t label_id) const noexcept { return is_bone_[label_id]; }
  /// The patient has no lesion of the task: its organ's healthy tissue is the target.
  bool is_parenchymal() const noexcept { return is_parenchymal_; }

 private:
  std::array<Part, 256> parts_{};
  std::array<const RiskStructure*, 256> risks_{};  // into the task
  std::array<Harm, 256> harms_{};
  std::array<bool, 256> is_bone_{};
  bool is_parenchymal_ = true;
};

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
