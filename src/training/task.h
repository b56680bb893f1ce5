#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue_table.h"
#include "core/result.h"

namespace trocar {

/// A structure that must not be touched, and how far a planned path stays away from it.
struct RiskStructure {
  std::string tissue;      ///< Tissue class ("vessel", "bowel", "lung", "bone" …), or
  std::string label;       ///< a label's name when tissue is empty.
  double margin_mm = 5.0;  ///< Range 0..50.
  double penalty = 20.0;   ///< Points lost when touched. Range 0..100.
};

/// A training task as data (data/tasks/NAME.toml).
struct Task {
  std::string name;  ///< "liver-biopsy".
  std::string title;
  std::string organ;                        ///< Label or tissue that holds the target: "liver".
  std::vector<std::string> target_tissues;  ///< "liver_lesion"; where the patient has none: parenchyma of the organ.
  std::string needle;                       ///< Name in data/needles.toml.
  std::string force_model = "insertion";    ///< insertion, proxy or combined; see docs/physics.md T2.
  std::vector<RiskStructure> risks;
  double min_organ_path_mm = 10.0;      ///< Organ passed before the target. Range 0..50.
  double parenchymal_depth_mm = 20.0;   ///< Target at least this deep below the organ's surface without a lesion.
  double parenchymal_vessel_mm = 10.0;  ///< ... and this far from large vessels.
  double max_path_mm = 150.0;           ///< Skin to the tip when it is at the target. Range 10..300.
  double max_entry_angle_deg = 60.0;    ///< Between the needle and the skin's normal. Range 5..85.
  double max_posterior_deg = 30.0;      ///< Supine patient: how far the skin's normal may look down. Range 0..90.
  // Scoring: the deviation at which a part is worth nothing.
  double target_tolerance_mm = 5.0;
  double entry_tolerance_mm = 10.0;
  double angle_tolerance_deg = 10.0;
  double time_limit_s = 120.0;
};

/// All tasks of a folder, ordered by name. Errors name file, line and key.
Result<std::vector<Task>> load_tasks(const std::filesystem::path& tasks_folder);
/// Unknown name: exit status 2, the message lists the names.
Result<Task> load_task(const std::filesystem::path& tasks_folder, std::string_view name);

/// Whether a label is the task's organ, target, or one of its risk structures (nullptr: none).
bool is_organ(const Task& task, const Label& label) noexcept;
bool is_target(const Task& task, const Label& label) noexcept;
const RiskStructure* find_risk(const Task& task, const Label& label) noexcept;

/// Whether a patient can serve a task, and what is missing or doubtful, in words.
struct TaskReadiness {
  bool is_possible = false;
  bool is_parenchymal = false;       ///< No lesion: the target lies in the organ's healthy tissue.
  std::vector<std::string> reasons;  ///< Why not, or what is doubtful.
};
TaskReadiness check_task(const Task& task, const VirtualPatient& patient);

}  // namespace trocar
