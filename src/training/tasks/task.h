#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"
#include "tasks/phases/phase.h"
#include "tasks/substance.h"

namespace trocar::tasks {

/// A structure that must not be touched, and the margin of a planned path to it.
struct RiskStructure {
  std::string tissue;        ///< Tissue class ("vessel", "bowel", "lung", "bone" …); empty: `label` is used.
  std::string label;         ///< A label's name; used when tissue is empty.
  double margin_mm = 5.0;    ///< Range 0..50.
  double penalty = 20.0;     ///< Points lost when touched. Range 0..100.
  bool is_optional = false;  ///< A patient without it is not doubtful: it stands in for what others have labelled.
  bool is_critical = false;  ///< An attempt that touches it is not passed, whatever its score.

  bool operator==(const RiskStructure&) const = default;
};

/// Permitted place of a needle's entry: the skin within a ball about one of its points.
struct EntryZone {
  Vec3 centre_P = Vec3::Zero();  ///< On the skin.
  double radius_mm = 20.0;       ///< Range 1..200.

  /// Distance of a point outside the zone, mm; 0 inside.
  double distance_outside_mm(const Vec3& p_P) const noexcept;
  bool operator==(const EntryZone&) const = default;
};

/// By which image the needle is guided.
enum class Guidance : std::uint8_t { kUltrasound, kXray, kPalpation };
const char* to_string(Guidance guidance) noexcept;

/// What hurts the patient.
struct PainRules {
  std::vector<std::string> tissues;  ///< Each new contact of the tip hurts: "bone" (periosteum), "nerve".
  bool needs_anaesthesia = false;    ///< The skin pierced without local anaesthetic hurts.

  bool operator==(const PainRules&) const = default;
};

/// Parts of a score that a task can weigh; scoring/score.h says what each means.
inline constexpr std::array kScoreParts{"target", "core", "confirmation", "risk",    "access",     "entry", "angle",
                                        "length", "time", "dose",         "comfort", "visibility", "passes"};

/// A training task as data (data/tasks/NAME.toml, or task.toml in a patient's folder).
struct Task {
  std::string name;  ///< "liver-biopsy".
  std::string title;
  std::string organ;                        ///< Label or tissue that holds the target: "liver".
  std::vector<std::string> target_tissues;  ///< "liver_lesion"; where the patient has none: parenchyma of the organ.
  std::string needle;                       ///< Name in data/needles.toml.
  std::vector<std::string> needles;         ///< Others that may be chosen; empty: all of the same use.
  std::size_t cores = 1;                    ///< Cores that a biopsy takes. Range 1..10.
  Guidance guidance = Guidance::kUltrasound;
  /// What has to come back for the target to count as reached; kNothing: nothing.
  Substance confirmed_by = Substance::kNothing;
  std::vector<Phase> phases;  ///< Steps of the procedure, in the file's order.
  PainRules pain;
  std::string force_model = "insertion";  ///< insertion, proxy or combined; see docs/physics.md T2.
  /// Engine of the ultrasound image: raycast, or panorama if the patient has one (docs/physics.md U17).
  std::string ultrasound_engine = "raycast";
  std::vector<RiskStructure> risks;
  // Settings that only a patient's own task has: they refer to places and structures of this patient.
  std::string target_label;             ///< The one label that is the target; empty: all of target_tissues.
  std::optional<Vec3> target_P;         ///< Target point; empty: the middle of a target's label.
  std::optional<EntryZone> entry_zone;  ///< Paths are planned inside it; an entry inside it is as good as the expert's.
  std::string expert_path;              ///< Name of the patient's path that is the expert's; empty: it is planned.
  double min_organ_path_mm = 10.0;      ///< Organ passed before the target. Range 0..50.
  double parenchymal_depth_mm = 20.0;   ///< Target at least this deep below the organ's surface without a lesion.
  double parenchymal_vessel_mm = 10.0;  ///< Target at least this far from large vessels without a lesion.
  double max_path_mm = 150.0;           ///< Skin to the tip when it is at the target. Range 10..300.
  double max_entry_angle_deg = 60.0;    ///< Between the needle and the skin's normal. Range 5..85.
  double max_posterior_deg = 30.0;      ///< Largest angle by which the skin may face down in the posture. Range 0..90.
  std::vector<std::string> passes;      ///< Tissues that a path may pass besides skin, fat, muscle and fluid.
  /// Long targets (a dural sac, bile ducts): a target point every so many mm, range 0..100; 0: the middle of each
  /// target.
  double target_step_mm = 0.0;
  std::string target_below;  ///< Name of a structure: target points lie below its lowest point (z); empty: anywhere.
  // Scoring: deviation at which a part gives half its points, and time at which it gives none.
  double target_tolerance_mm = 5.0;
  double entry_tolerance_mm = 10.0;
  double angle_tolerance_deg = 10.0;
  double time_limit_s = 120.0;
  double dose_limit_gycm2 = 0.0;     ///< Dose–area product of X-ray that gives no points for it; 0: not scored.
  double margin_tolerance_mm = 2.0;  ///< Missing margin to a structure at risk that halves the points of the access.
  /// Points of each part (kScoreParts); their sum is 100.
  std::map<std::string, double, std::less<>> weights;
  double pass_mark = 70.0;         ///< Least score of a passed attempt. Range 0..100.
  bool exam_shows_needle = false;  ///< In an exam slices and 3D show the needle inside the body, too.

  bool operator==(const Task&) const = default;
};

/// File in a patient's folder: the task that was made for it.
inline constexpr const char* kOwnTaskFile = "task.toml";

/// All tasks of a folder, ordered by name. Errors name file, line and key.
Result<std::vector<Task>> load_tasks(const std::filesystem::path& tasks_folder);
/// Unknown name: exit status 2, the message lists the names.
Result<Task> load_task(const std::filesystem::path& tasks_folder, std::string_view name);
/// Loads a task from a file: a complete one, or one with `base = "liver-biopsy"`, a task of the folder, and only the
/// differences from it; a list of [[risks]] replaces the base's. With a base the task keeps the base's name.
Result<Task> load_task_file(const std::filesystem::path& file, const std::filesystem::path& tasks_folder);
/// The same for the text of such a file; `name`: name of a complete task, its file name without `.toml`. `where`: for
/// messages.
Result<Task> parse_task(std::string_view text, const std::string& name, const std::string& where,
                        const std::filesystem::path& tasks_folder);
/// Text of such a file: the differences of `task` from `base`.
std::string task_to_toml(const Task& task, const Task& base);

/// True if a label is the task's organ or target; its risk structure in the task (nullptr: none). A risk that is named
/// by its tissue excludes organ and target: a biopsy of the pancreas can have "organ" as a risk.
bool is_organ(const Task& task, const anatomy::Label& label) noexcept;
bool is_target(const Task& task, const anatomy::Label& label) noexcept;
const RiskStructure* find_risk(const Task& task, const anatomy::Label& label) noexcept;

/// The target lies in the organ's healthy tissue: no label of the patient is a target, or the task's point is in none.
bool is_parenchymal(const Task& task, const anatomy::VirtualPatient& patient);

/// Checks if a patient supports a task; lists missing and doubtful requirements.
struct TaskReadiness {
  bool is_possible = false;
  bool is_parenchymal = false;       ///< No lesion: the target is in the organ's healthy tissue.
  std::vector<std::string> reasons;  ///< Reasons why it is not possible, or doubts.
};
TaskReadiness check_task(const Task& task, const anatomy::VirtualPatient& patient);

}  // namespace trocar::tasks
