#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/build_patient.h"
#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "io/image/image_file.h"
#include "registration/ct_ultrasound/landmark_fit.h"
#include "registration/shadow/beams.h"
#include "tasks/task.h"

namespace trocar::case_builder {

/// Imported data: immutable, shared by all drafts.
struct ImportedPatient {
  anatomy::VirtualPatient patient;
  std::vector<anatomy::NamedMesh> meshes;            ///< Surfaces by the names that the labels had at the import.
  std::vector<anatomy::LabelStatistics> statistics;  ///< Statistics of the patient's labels.
  std::vector<std::string> warnings;                 ///< Warnings of the import, one line each.
  std::vector<anatomy::Finding> findings;            ///< Of the segmentation (segmentation_findings).
  std::vector<anatomy::AnatomyFinding> findings;     ///< About the whole segmentation; some may be confirmed.
  std::string source;                                ///< As given by the user: a file, a folder, an embedded patient.
  std::string own_tissues;                           ///< Text of the patient's own tissue table; empty: none.
};

/// A recorded ultrasound volume: immutable, shared by all drafts. Frame U: that of the volume.
struct ImportedUltrasound {
  volume::LabelGrid gray_U;
  volume::MaskGrid imaged_U;  ///< 1 where it shows the body.
  double white = 255.0;       ///< Gray level to show white.
  io::ImageFields fields;     ///< Of its header.
  registration::Beams beams;
  std::string source;                 ///< File.
  std::vector<std::string> warnings;  ///< What was found while it was read.
};

enum class PlacementOrigin : std::uint8_t {
  kSaved,      ///< Read with the patient.
  kLandmarks,  ///< Fit of landmark pairs.
  kOptimised   ///< Mutual information.
};

/// Pose of the recorded ultrasound in the CT.
struct UltrasoundPlacement {
  Pose X_PU;
  PlacementOrigin origin = PlacementOrigin::kSaved;
  double confidence = 0.0;  ///< 0..1, of kOptimised (docs/physics.md R13).
};

/// A case that is being built, as a value. Copies share the volumes, so that a copy costs some kilobytes. Frame P.
struct CaseDraft {
  std::shared_ptr<const ImportedPatient> imported;  ///< Null: nothing was imported yet.
  std::string name;
  std::string description;
  std::vector<std::string> provenance;
  anatomy::LabelTable label_table;  ///< Current names, tissues and colours.
  std::vector<anatomy::Landmark> landmarks;
  std::vector<anatomy::NeedlePath> paths;                      ///< The task's expert_path is the name of one of them.
  std::shared_ptr<const ImportedUltrasound> ultrasound;        ///< Null: none.
  std::vector<registration::NamedPoint> ultrasound_landmarks;  ///< Frame U; paired by name with `landmarks`.
  std::optional<UltrasoundPlacement> placement;                ///< Empty: not yet placed in the CT.
  tasks::Task base;                                            ///< The template.
  tasks::Task task;                                            ///< The template with its changes.
};

/// True if two drafts of the same import are equal.
bool is_same_draft(const CaseDraft& a, const CaseDraft& b);

/// Expert path of the task, or nullptr: then the path is planned each time the case is opened.
const anatomy::NeedlePath* find_expert_path(const CaseDraft& draft) noexcept;

/// Centre of the target: the task's point, else the centroid of the target's label, or of the largest label of the
/// task's target tissues; empty if there is none.
std::optional<Vec3> find_target_point(const CaseDraft& draft);

}  // namespace trocar::case_builder
