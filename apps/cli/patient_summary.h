#pragma once

#include <string>
#include <vector>

#include "anatomy/build_patient.h"
#include "anatomy/patient.h"
#include "output.h"
#include "tasks/task.h"

namespace trocar::cli {

// Parts of the JSON that `patient` prints about a patient.
Json to_json(const Vec3& v);
Json grid_json(const GridGeometry& geometry);
Json label_json(const VirtualPatient& patient, const LabelStatistics& statistics);
Json mesh_json(const NamedMesh& mesh);
Json readiness_json(const Task& task, const TaskReadiness& readiness);

/// What `patient build` reports about the patient that it has made.
struct BuildSummary {
  std::string folder;
  std::vector<LabelStatistics> labels;
  double body_ml = 0.0;
  std::vector<std::string> warnings, doubts;
  std::vector<Task> tasks;
  std::vector<TaskReadiness> readiness;  ///< Of each task.
};
BuildSummary summarize_build(const VirtualPatient& patient, const std::vector<Task>& tasks,
                             std::vector<std::string> warnings, const std::string& folder);
Json to_json(const BuildSummary& summary, const VirtualPatient& patient, const std::vector<NamedMesh>& meshes);
void print_summary(const BuildSummary& summary, const VirtualPatient& patient, const std::vector<NamedMesh>& meshes);

}  // namespace trocar::cli
