#pragma once

#include <array>
#include <vector>

#include "anatomy/patient.h"
#include "tasks/task.h"

namespace trocar::tasks::detail {

/// Role of a label for a needle on its path. Tissues that the task lets pass count as muscle: both are the wall.
enum class Role : std::uint8_t { kPassable, kMuscle, kOrgan, kTarget, kForbidden };

/// Roles of a patient's labels in a task, and distances to the risk structures. References the task and the patient.
struct PlanningMap {
  const Task& task;
  const anatomy::VirtualPatient& patient;
  std::array<Role, 256> roles{};
  std::array<const RiskStructure*, 256> risks{};  ///< By label id; nullptr: none.
  double largest_margin_mm = 0.0;                 ///< Largest margin of the risks that exist in the patient.
  volume::FloatGrid clearance_mm{};               ///< Coarse: distance to the nearest risk cell minus its margin.
  anatomy::Posture posture = anatomy::Posture::kSupine;  ///< In which entries are judged.
  double slack_mm = 0.0;  ///< The coarse clearance may err by this (half the diagonal of a cell).

  Role role_at(const Vec3& p_P) const noexcept;
};

/// Target points of the middle of the notch (or the tip).
struct PlanTargets {
  std::vector<Vec3> points_P;
  bool is_parenchymal = false;
};

/// Roles and risks of the labels; no distances yet.
PlanningMap make_planning_map(const Task& task, const anatomy::VirtualPatient& patient);

/// The deepest point of each lesion, largest first; without a lesion points of the organ at the task's depth and
/// distance to vessels, those nearest to the skin first.
Result<PlanTargets> find_targets(const PlanningMap& map);

/// Fills the clearance in the part of the volume that lies within `reach_mm` of a target.
void measure_clearance(PlanningMap& map, const PlanTargets& targets, double reach_mm);

}  // namespace trocar::tasks::detail
