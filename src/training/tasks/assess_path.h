#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "tasks/needle.h"
#include "tasks/plan.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// Faults of a path that a user drew.
enum class PathFault : std::uint8_t {
  kNotOnSkin,    ///< It does not begin at the skin.
  kTooLong,      ///< It is too long for the task or for the needle.
  kGlancing,     ///< The angle between needle and skin is too flat.
  kOutOfReach,   ///< The skin faces downwards: the patient lies on it.
  kOutsideZone,  ///< It begins outside the entry zone.
  kCrosses,      ///< It goes through a structure that no path may pass.
  kMargin,       ///< It comes nearer to a risk structure than its margin.
  kOrganPath,    ///< It passes too little of the organ before the target.
  kOffTarget,    ///< The needle does not reach the target.
};

struct PathFinding {
  PathFault fault = PathFault::kCrosses;
  std::string label;  ///< The structure's name, where there is one.
  std::string text;   ///< Description: what, where, by how much.
  Vec3 where_P = Vec3::Zero();
  double depth_mm = 0.0;      ///< Depth of where_P along the path, from its entry.
  double clearance_mm = 0.0;  ///< Distance to the structure's surface; 0: it is crossed.
};

/// A drawn path, measured like the planner's own paths, with all its faults, not only the first.
struct PathAssessment {
  PlannedPath path;
  double entry_angle_deg = 0.0;   ///< Between the needle and the skin's normal.
  double skin_distance_mm = 0.0;  ///< Skin distance of the path's begin; negative inside the body.
  std::vector<PathFinding> findings;
};

/// `line_P`: from the skin to the end position of the tip; for a biopsy needle the throw beyond it is checked, too.
/// Takes some 10 ms at 1 mm voxels; more with wide margins.
PathAssessment assess_path(const Task& task, const anatomy::VirtualPatient& patient, const Needle& needle,
                           const Segment& line_P);

/// The point of the skin where the line from a target outwards through `towards_P` leaves the body; empty if that is
/// beyond the volume or `longest_mm`.
std::optional<Vec3> find_skin_entry(const anatomy::VirtualPatient& patient, const Vec3& target_P, const Vec3& towards_P,
                                    double longest_mm = 400.0);
/// The point of the skin nearest to a point; empty if there is no skin within `reach_mm`.
std::optional<Vec3> find_nearest_skin(const anatomy::VirtualPatient& patient, const Vec3& p_P, double reach_mm = 60.0);

/// Runs check_task and, if nothing is missing, the planner: a patient without a safe path cannot serve the task. The
/// planner's error is then the last of the reasons. `patient check` uses this function and therefore agrees with
/// `plan`.
TaskReadiness check_task_and_paths(const Task& task, const anatomy::VirtualPatient& patient, const Needle& needle,
                                   const Progress& progress = {});

}  // namespace trocar::tasks
