#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/label_statistics.h"
#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "cases/force_curve.h"
#include "core/result.h"
#include "core/step_history.h"
#include "geometry/pose.h"
#include "io/image/image_file.h"
#include "patient_builder/build_patient.h"
#include "registration/ct_ultrasound/landmark_fit.h"
#include "registration/shadow/beams.h"
#include "tasks/needle.h"
#include "tasks/task.h"
#include "volume/grid.h"

namespace trocar::case_builder {

/// Imported data: immutable, shared by all drafts.
struct ImportedPatient {
  anatomy::VirtualPatient patient;
  std::vector<anatomy::NamedMesh> meshes;                 ///< Surfaces by the names that the labels had at the import.
  std::vector<anatomy::LabelStatistics> statistics;       ///< Statistics of the patient's labels.
  std::vector<std::string> warnings;                      ///< Warnings of the import, one line each.
  std::vector<anatomy::Finding> label_findings;           ///< Of the segmentation (segmentation_findings).
  std::vector<patient_builder::AnatomyFinding> findings;  ///< About the whole segmentation; some may be confirmed.
  std::string source;       ///< As given by the user: a file, a folder, an embedded patient.
  std::string own_tissues;  ///< Text of the patient's own tissue table; empty: none.
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

/// The draft with its undo and redo steps. At most kMaxSteps are kept, some kilobytes each; the volumes of the import
/// are shared. A new import begins a new history, so that no more than one import is held.
class CaseHistory {
 public:
  static constexpr std::size_t kMaxSteps = 200;

  const CaseDraft& draft() const noexcept { return steps_.now().draft; }
  /// Counts every change of the draft, undo and redo included.
  std::uint64_t version() const noexcept { return version_; }

  /// Removes all steps and starts with `draft`.
  void begin(CaseDraft draft);
  /// Adds one step. `what`: text for the buttons. Consecutive steps with the same `gesture` (a drag, a spin box) are
  /// merged; empty: a separate step. A draft without a change adds no step.
  void apply(CaseDraft next, std::string what, const std::string& gesture = {});

  bool can_undo() const noexcept { return steps_.can_undo(); }
  bool can_redo() const noexcept { return steps_.can_redo(); }
  std::string undo_text() const { return can_undo() ? steps_.now().what : std::string(); }
  std::string redo_text() const { return can_redo() ? steps_.next().what : std::string(); }
  void undo();  ///< No effect if there is nothing to undo.
  void redo();

 private:
  struct Step {
    CaseDraft draft;
    std::string what;  ///< Text of the step that led to it.
  };
  StepHistory<Step> steps_{kMaxSteps};
  std::string gesture_;
  std::uint64_t version_ = 0;
};

/// The patient of a draft. With unedited labels it is the import itself; with edited labels the first request copies
/// the volumes: call it from a worker thread. Caches the newest one.
class DraftPatient {
 public:
  /// With the draft's label table; landmarks, paths and texts are those of the import. The draft must have an import.
  std::shared_ptr<const anatomy::VirtualPatient> of(const CaseDraft& draft);
  /// The same if no labels must be copied; otherwise null.
  std::shared_ptr<const anatomy::VirtualPatient> find(const CaseDraft& draft) const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const ImportedPatient> of_import_;
  std::shared_ptr<const anatomy::VirtualPatient> edited_;
};

/// Surfaces with the current names of their labels; those of the import itself if no name was changed.
std::shared_ptr<const std::vector<anatomy::NamedMesh>> draft_meshes(const CaseDraft& draft);

/// Predicted force on the hand along the expert's path: at 10 mm/s, without the stylus' weight.
struct ForcePreview {
  std::vector<cases::CurvePoint> curve;
  std::vector<cases::CurveEvent> events;  ///< Punctured layers.
  std::vector<cases::PathPiece> pieces;   ///< Tissue from the skin to the path's end.
  double highest_n = 0.0;
};

/// With the task's force model. Errors: no path, a label with a tissue that is not in the table. Takes about 0.1 s.
Result<ForcePreview> preview_forces(const CaseDraft& draft, std::shared_ptr<const anatomy::VirtualPatient> patient,
                                    const tasks::Needle& needle, const anatomy::TissueTable& tissues);

}  // namespace trocar::case_builder

namespace trocar::case_builder::detail {

/// Error: a point outside the box of a grid's voxels. `what`: "landmark"; `advice`: "click inside the ultrasound".
inline Status check_in_volume(const volume::GridGeometry& grid, const Vec3& p, const char* what, const char* advice) {
  const Vec3 index = grid.to_index(p);
  for (int a = 0; a < 3; ++a)
    if (!(index[a] >= -0.5 && index[a] <= static_cast<double>(grid.size[static_cast<std::size_t>(a)]) - 0.5))
      return fail(fmt::format("the {} is outside the volume", what),
                  fmt::format("({:.0f}, {:.0f}, {:.0f}) mm", p.x(), p.y(), p.z()), advice);
  return {};
}

}  // namespace trocar::case_builder::detail
