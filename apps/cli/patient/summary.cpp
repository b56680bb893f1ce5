#include "cli/patient/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "anatomy/label_statistics.h"
#include "cli/constants.h"
#include "cli/json_parts.h"
#include "config/json.h"
#include "core/files/folders.h"
#include "geometry/shapes.h"
#include "patient_builder/patient_findings.h"
#include "tasks/assess_path.h"
#include "tasks/needle.h"

namespace trocar::cli {
namespace {

double body_volume_ml(const volume::FloatGrid& skin_distance_mm) {
  const auto inside = std::count_if(skin_distance_mm.voxels.begin(), skin_distance_mm.voxels.end(),
                                    [](float distance_mm) { return distance_mm < 0.0F; });
  return static_cast<double>(inside) * skin_distance_mm.geometry.spacing_mm.prod() / kMm3PerMl;
}

std::size_t triangle_count(const std::vector<anatomy::NamedMesh>& meshes) {
  std::size_t count = 0;
  for (const anatomy::NamedMesh& mesh : meshes) count += mesh.mesh_P.triangles.size();
  return count;
}

}  // namespace

config::Json grid_json(const volume::GridGeometry& g) {
  config::Json direction = config::Json::array();
  for (int axis = 0; axis < 3; ++axis) direction.push_back(vector_json(Vec3(g.R_PV.col(axis))));
  return {{"frame", "P: LPS, mm"},
          {"size_voxels", {g.size[0], g.size[1], g.size[2]}},
          {"spacing_mm", vector_json(g.spacing_mm)},
          {"origin_mm", vector_json(g.origin_P)},
          {"direction_of_ijk", direction}};
}

config::Json label_json(const anatomy::VirtualPatient& patient, const anatomy::LabelStatistics& s) {
  const anatomy::Label* label = patient.label_table.find(s.id);
  return {{"id", s.id},
          {"name", label != nullptr ? label->name : ""},
          {"tissue", label != nullptr ? label->tissue : ""},
          {"volume_ml", s.volume_ml},
          {"mean_hu", s.mean_hu},
          {"derived", label != nullptr && label->is_derived},
          {"voxels", s.voxels},
          {"centroid_mm", vector_json(s.centroid_P)},
          {"touches_border", s.touches_border}};
}

config::Json mesh_json(const anatomy::NamedMesh& mesh) {
  return {{"name", mesh.name},
          {"vertices", mesh.mesh_P.vertices.size()},
          {"triangles", mesh.mesh_P.triangles.size()},
          {"area_cm2", area_mm2(mesh.mesh_P) / kMm2PerCm2},
          {"volume_ml", enclosed_volume_mm3(mesh.mesh_P) / kMm3PerMl}};
}

config::Json readiness_json(const tasks::Task& task, const tasks::TaskReadiness& readiness) {
  return {{"task", task.name},
          {"possible", readiness.is_possible},
          {"parenchymal", readiness.is_parenchymal},
          {"posture", readiness.posture ? config::Json(std::string(anatomy::posture_name(*readiness.posture)))
                                        : config::Json(nullptr)},
          {"reasons", readiness.reasons}};
}

BuildSummary summarize_build(const anatomy::VirtualPatient& patient, const std::vector<tasks::Task>& tasks,
                             std::vector<std::string> warnings, const std::string& folder) {
  BuildSummary summary;
  summary.folder = folder;
  summary.labels = anatomy::label_statistics(patient);
  summary.body_ml = body_volume_ml(patient.skin_distance_mm);
  summary.warnings = std::move(warnings);
  for (const anatomy::Finding& finding : patient_builder::all_patient_findings(patient, summary.labels))
    summary.findings.push_back(finding.text);
  summary.tasks = tasks;
  for (const tasks::Task& task : tasks) {
    const auto needle = tasks::load_needle(data_dir() / "needles.toml", task.needle);
    summary.readiness.push_back(needle ? tasks::check_task_and_paths(task, patient, *needle)
                                       : tasks::check_task(task, patient));
  }
  return summary;
}

config::Json to_json(const BuildSummary& summary, const anatomy::VirtualPatient& patient,
                     const std::vector<anatomy::NamedMesh>& meshes) {
  config::Json labels = config::Json::array();
  for (const anatomy::LabelStatistics& s : summary.labels) labels.push_back(label_json(patient, s));
  config::Json surfaces = config::Json::array();
  for (const anatomy::NamedMesh& mesh : meshes) surfaces.push_back(mesh_json(mesh));
  config::Json tasks = config::Json::array();
  for (std::size_t n = 0; n < summary.tasks.size(); ++n)
    tasks.push_back(readiness_json(summary.tasks[n], summary.readiness[n]));
  return {{"folder", summary.folder},
          {"name", patient.name},
          {"content_hash", patient.content_hash},
          {"volume", grid_json(patient.ct.geometry)},
          {"body_ml", summary.body_ml},
          {"labels", labels},
          {"meshes", surfaces},
          {"tasks", tasks},
          {"doubtful", summary.findings},
          {"warnings", summary.warnings}};
}

void print_summary(const BuildSummary& summary, const anatomy::VirtualPatient& patient,
                   const std::vector<anatomy::NamedMesh>& meshes) {
  const volume::GridGeometry& g = patient.ct.geometry;
  fmt::print("{} in {}\n", patient.name, summary.folder);
  fmt::print("volume    {} x {} x {} voxels of {:.3f} x {:.3f} x {:.3f} mm\n", g.size[0], g.size[1], g.size[2],
             g.spacing_mm.x(), g.spacing_mm.y(), g.spacing_mm.z());
  fmt::print("body      {:.1f} l\n", summary.body_ml / 1000.0);
  fmt::print("surfaces  {}, {} triangles\n", meshes.size(), triangle_count(meshes));
  fmt::print("labels    {}\n", summary.labels.size());
  for (const anatomy::LabelStatistics& s : summary.labels)
    if (const anatomy::Label* label = patient.label_table.find(s.id))
      fmt::print("  {:<30} {:>9.1f} ml {:>6.0f} HU{}\n", label->name, s.volume_ml, s.mean_hu,
                 label->is_derived ? "  derived" : "");
  std::vector<std::string> possible;
  for (std::size_t n = 0; n < summary.tasks.size(); ++n)
    if (const tasks::TaskReadiness& readiness = summary.readiness[n]; readiness.is_possible)
      possible.push_back(summary.tasks[n].name +
                         (readiness.posture ? fmt::format(" ({})", anatomy::posture_name(*readiness.posture)) : ""));
  fmt::print("tasks     {}\n",
             possible.empty() ? "none; see trocar patient check" : fmt::format("{}", fmt::join(possible, ", ")));
  if (!summary.findings.empty()) fmt::print("doubtful\n");
  for (const std::string& finding : summary.findings) fmt::print("  {}\n", finding);
}

}  // namespace trocar::cli
