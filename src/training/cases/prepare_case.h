#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "core/progress.h"
#include "core/result.h"
#include "motion/breathing.h"
#include "tasks/action.h"
#include "tasks/needle.h"
#include "tasks/plan.h"
#include "tasks/task.h"
#include "xray/contrast/duct_tree.h"

namespace trocar::cases {

/// Selection of an attempt; empty texts mean the default.
struct CaseOptions {
  /// Name of a task of the data folder, or a task file (ends in .toml); empty: the patient's own task.
  std::string task = "liver-biopsy";
  std::string patient_folder;  ///< Folder of the patient's own task and tissues; empty or an embedded one: none.
  /// Name in data/needles.toml; empty: the task's needle, or a longer one of the task where that does not reach.
  std::string needle;
  std::string tissue_file;             ///< Empty: the patient's own table, else data/tissues.toml.
  std::string profile;                 ///< Profile of the tissue file; without a file, of data/tissues.toml.
  std::vector<std::string> overrides;  ///< "liver.k=0.5"
  std::string posture;                 ///< Posture of the patient; empty: tried in the order of tasks::postures_to_try.
  std::string level;                   ///< Name or number of a level of the task; empty: the task as it is.
  /// How the patient breathes, as motion::parse_breathing() reads it; empty: as the task says, if the patient has a
  /// motion model.
  std::string breathing;
  std::optional<double> held_phase = {};  ///< The patient is held at this phase of the breath, 0..1.
  std::uint64_t seed = 1;
};

/// A patient, a task and a planned path: all that an attempt needs.
struct Case {
  std::shared_ptr<const anatomy::VirtualPatient> patient;
  tasks::Task task;
  std::string task_toml;  ///< Text of the task's file; empty: a task of the data folder.
  tasks::Needle needle;
  anatomy::TissueTable tissues;
  tasks::SubstanceTable substances;
  tasks::PlannedPath plan;                  ///< The expert path that is shown.
  std::vector<tasks::PlannedPath> experts;  ///< The plan, then others; an attempt is compared with the nearest.
  bool is_parenchymal = false;
  /// What moves the patient; begins_s: session time of an attempt without servers. Without any depth the patient rests.
  motion::MotionDrive breathing = {};
  std::shared_ptr<const xray::DuctTree> ducts;  ///< Of a task that advances a guide wire; else null.

  /// `experts`; in a case made without them the plan alone.
  std::span<const tasks::PlannedPath> expert_paths() const noexcept {
    return experts.empty() ? std::span<const tasks::PlannedPath>(&plan, 1) : experts;
  }
};

/// Task, needle and tissues from the data folder, without a patient: detects their errors early.
Result<Case> load_tables(const CaseOptions& options);

/// Source of an embedded patient with the body of a level: "biopsy-1@weight_kg=1.3".
std::string with_body(const std::string& patient, const tasks::Tier& level);

/// The drive of a patient who breathes as a text says (empty: not), held at a phase of the breath if there is one (then
/// quietly, if the text is empty). `seed`: of what varies, unless the text has one. Errors (exit status 2): not such a
/// text, a patient without a motion model.
Result<motion::MotionDrive> breathing_of(const anatomy::VirtualPatient& patient, const std::string& text,
                                         const std::optional<double>& held_phase, std::uint64_t seed = 1);

/// The plan of a case and the other paths that the patient brings for its task. A biopsy needle has only its plan.
std::vector<tasks::PlannedPath> find_experts(const Case& the_case, const anatomy::VirtualPatient& patient);

/// True if a patient has its own task: a folder with task.toml in it.
bool has_own_task(const std::string& patient_folder);

/// File in a patient's folder: the tissue table that was fitted to it.
inline constexpr const char* kOwnTissueFile = "tissues.toml";
/// True if a patient has its own tissue table.
bool has_own_tissues(const std::string& patient_folder);
/// That table. Its origin names the patient's file. Errors: those of load_tissue_table.
Result<anatomy::TissueTable> load_own_tissues(const std::string& patient_folder);

/// Loads tables and task, checks that the patient can serve the task, and plans the expert path, or uses the one that
/// the task names. Errors name the missing structure or the margin that leaves no path.
Result<Case> prepare_case(std::shared_ptr<const anatomy::VirtualPatient> patient, const CaseOptions& options,
                          const Progress& progress = {});

}  // namespace trocar::cases
