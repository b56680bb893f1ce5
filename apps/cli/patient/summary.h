#pragma once

#include <string>
#include <vector>

#include "anatomy/label_statistics.h"
#include "anatomy/patient.h"
#include "cli/output.h"
#include "tasks/task.h"

namespace trocar::cli {

// Parts of the JSON output of `patient`.
config::Json grid_json(const volume::GridGeometry& geometry);
config::Json label_json(const anatomy::VirtualPatient& patient, const anatomy::LabelStatistics& statistics);
config::Json mesh_json(const anatomy::NamedMesh& mesh);
config::Json readiness_json(const tasks::Task& task, const tasks::TaskReadiness& readiness);

/// Report of `patient build` about the new patient.
struct BuildSummary {
  std::string folder;
  std::vector<anatomy::LabelStatistics> labels;
  double body_ml = 0.0;
  std::vector<std::string> warnings, findings;
  std::vector<tasks::Task> tasks;
  std::vector<tasks::TaskReadiness> readiness;  ///< One element per task.
};
BuildSummary summarize_build(const anatomy::VirtualPatient& patient, const std::vector<tasks::Task>& tasks,
                             std::vector<std::string> warnings, const std::string& folder);
config::Json to_json(const BuildSummary& summary, const anatomy::VirtualPatient& patient,
                     const std::vector<anatomy::NamedMesh>& meshes);
void print_summary(const BuildSummary& summary, const anatomy::VirtualPatient& patient,
                   const std::vector<anatomy::NamedMesh>& meshes);

}  // namespace trocar::cli
