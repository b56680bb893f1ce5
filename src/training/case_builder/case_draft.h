#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/build_patient.h"
#include "anatomy/patient.h"
#include "tasks/task.h"

namespace trocar::case_builder {

/// What was imported: immutable, and shared by every draft that is made of it.
struct ImportedPatient {
  anatomy::VirtualPatient patient;
  std::vector<anatomy::NamedMesh> meshes;            ///< By the names that the labels had at the import.
  std::vector<anatomy::LabelStatistics> statistics;  ///< Of the patient's labels.
  std::vector<std::string> warnings;                 ///< Of the import, a line each.
  std::string source;                                ///< As it was named: a file, a folder, an embedded patient.
};

/// A case while it is made: a value. The volumes are shared, so that a copy costs some kilobytes. Frame P.
struct CaseDraft {
  std::shared_ptr<const ImportedPatient> imported;  ///< Null: nothing was imported yet.
  std::string name;
  std::string description;
  std::vector<std::string> provenance;
  anatomy::LabelTable label_table;  ///< Names, tissues and colours as they are now.
  std::vector<anatomy::Landmark> landmarks;
  std::vector<anatomy::NeedlePath> paths;  ///< The task's expert_path is the name of one of them.
  tasks::Task base;                        ///< The template.
  tasks::Task task;                        ///< The template with its changes.
};

/// Whether two drafts say the same of the same import.
bool is_same_draft(const CaseDraft& a, const CaseDraft& b);

/// The path that the task names; nullptr: none is drawn, the path is planned when the case is opened.
const anatomy::NeedlePath* find_expert_path(const CaseDraft& draft) noexcept;

/// The middle of the target: the task's point, else the centroid of the target's label, or of the largest label of the
/// task's target tissues; nothing where the patient has none.
std::optional<Vec3> find_target_point(const CaseDraft& draft);

}  // namespace trocar::case_builder
