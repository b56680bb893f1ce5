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
#include "tasks/action.h"
#include "tasks/harm.h"
#include "tasks/phases/phase.h"

namespace trocar::tasks {

/// A structure that must not be touched, and the margin of a planned path to it.
struct RiskStructure {
  std::string tissue;        ///< Tissue class ("vessel", "bowel", "lung", "bone" …); empty: `label` is used.
  std::string label;         ///< A label's name; used when tissue is empty.
  double margin_mm = 5.0;    ///< Range 0..50.
  bool is_optional = false;  ///< A patient without it is not doubtful: it stands in for what others have labelled.
  std::optional<Harm> harm;  ///< Overrides the table of harm in this task; empty: as there.

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

/// Entry zone about a landmark, found in each patient that has it (fit_to_patient.h).
struct LandmarkZone {
  std::string landmark;     ///< "left anterior superior iliac spine"; `left` or `right` says where medial is.
  double medial_mm = 0.0;   ///< Over the skin towards the midline. Range -150..150.
  double cranial_mm = 0.0;  ///< Over the skin towards the head. Range -150..150.
  double radius_mm = 25.0;  ///< Range 1..200.

  bool operator==(const LandmarkZone&) const = default;
};

/// Highest level at which the target may be entered: an attempt that enters it above the middle of a structure is not
/// passed.
struct EntryLevel {
  std::string above;   ///< A label's name: "vertebrae_L2".
  std::string reason;  ///< For the trainee: "the needle went in above L2/L3 …".

  bool operator==(const EntryLevel&) const = default;
};

/// Fibres that a bevel has to part instead of cutting them: its face looks across them.
struct BevelRule {
  std::string layer;            ///< Layer of the tissue table whose punctures are judged: "dura".
  std::string fibres;           ///< Tissue class or label along which they run: "csf".
  double tolerance_deg = 30.0;  ///< Angle that halves the points. Range 1..90.

  bool operator==(const BevelRule&) const = default;
};

/// A level of difficulty of a task.
struct Tier {
  std::string name;                         ///< "hard"
  std::string title;                        ///< One line: what is harder.
  std::optional<double> breathing_mm = {};  ///< Replaces the task's. Range 0..40.
  double tremor_mm = 0.0;        ///< Added to a scripted operator's hand, rms of each lateral axis. Range 0..3.
  double time_limit_s = 0.0;     ///< Replaces the task's; 0: does not. Range 0..3600.
  double tolerance_share = 1.0;  ///< Factor on the tolerances of the score. Range 0.1..2.
  /// Factors on numbers of an embedded patient's body (data/phantoms/cases.toml): "weight_kg" 1.3. Range 0.2..5.
  std::map<std::string, double, std::less<>> body;

  bool operator==(const Tier&) const = default;
};

/// By which image the needle is guided.
enum class ImagingModality : std::uint8_t { kUltrasound, kXray, kPalpation };
const char* to_string(ImagingModality guidance) noexcept;

/// What hurts the patient.
struct PainRules {
  std::vector<std::string> tissues;  ///< Each new contact of the tip hurts: "bone" (periosteum), "nerve".
  bool needs_anaesthesia = false;    ///< The skin pierced where no local anaesthetic was injected hurts.

  bool operator==(const PainRules&) const = default;
};

/// Parts of a score that a task can weigh; scoring/score.h says what each means.
inline constexpr std::array kScoreParts{"target", "core", "confirmation", "risk",    "access",     "entry",  "angle",
                                        "length", "time", "dose",         "comfort", "visibility", "passes", "bevel"};

/// A training task as data (data/tasks/NAME.toml, or task.toml in a patient's folder).
struct Task {
  std::string name;  ///< "liver-biopsy".
  std::string title;
  std::string organ;                        ///< Label or tissue that holds the target: "liver".
  std::vector<std::string> target_tissues;  ///< "liver_lesion"; where the patient has none: parenchyma of the organ.
  std::string needle;                       ///< Name in data/needles.toml.
  std::vector<std::string> needles;         ///< Others that may be chosen; empty: all of the same use.
  std::size_t cores = 1;                    ///< Cores that a biopsy takes. Range 1..10.
  ImagingModality guidance = ImagingModality::kUltrasound;
  /// What has to come back for the target to count as reached; kNothing: nothing.
  Substance confirmed_by = Substance::kNothing;
  std::vector<Phase> phases;  ///< Steps of the procedure, in the file's order.
  PainRules pain;
  /// How far (mm) the liver moves down in a breath of the patient, unless told otherwise; 0: not at all. Range 0..40.
  double breathing_mm = 0.0;
  std::string force_model = "insertion";  ///< insertion, proxy or combined; see docs/physics.md T2.
  /// Engine of the ultrasound image: raycast, or panorama if the patient has one (docs/physics.md U17).
  std::string ultrasound_engine = "raycast";
  std::vector<RiskStructure> risks;
  /// What a needle does to each structure: the task's own rows, then those of the table (data/harm.toml).
  std::vector<HarmRule> harms;
  // Settings that only a patient's own task has: they refer to places and structures of this patient.
  std::string target_label;      ///< The one label that is the target; empty: all of target_tissues.
  std::optional<Vec3> target_P;  ///< Target point; empty: the middle of a target's label.
  /// Paths are planned inside it; an entry inside it is as good as the expert's. From `landmark_zone` if there is one.
  std::optional<EntryZone> entry_zone;
  std::string expert_path;              ///< Name of the patient's path that is the expert's; empty: it is planned.
  double min_organ_path_mm = 10.0;      ///< Organ passed before the target. Range 0..50.
  double parenchymal_depth_mm = 20.0;   ///< Target at least this deep below the organ's surface without a lesion.
  double parenchymal_vessel_mm = 10.0;  ///< Target at least this far from large vessels without a lesion.
  double max_path_mm = 150.0;           ///< Skin to the tip when it is at the target. Range 10..300.
  double max_entry_angle_deg = 60.0;    ///< Between the needle and the skin's normal. Range 5..85.
  double max_posterior_deg = 30.0;      ///< Largest angle by which the skin may face down in the posture. Range 0..90.
  /// Postures in which the puncture is done, the best first; empty: as the patient lies.
  std::vector<anatomy::Posture> postures;
  std::optional<anatomy::Posture> posture;  ///< The one of an attempt; empty: see postures_to_try.
  std::vector<std::string> passes;          ///< Tissues that a path may pass besides skin, fat, muscle and fluid.
  /// Long targets (a dural sac, bile ducts): a target point every so many mm, range 0..100; 0: the middle of each
  /// target.
  double target_step_mm = 0.0;
  /// The target has to be labelled, with so much (ml) in one piece. Range 0..1000; 0: it need not.
  double least_target_ml = 0.0;
  std::string target_below;  ///< Name of a structure: target points lie below its lowest point (z); empty: anywhere.
  /// Landmark from which the target keeps at least so far: central ducts lie beside large vessels. Empty: none.
  std::string target_away_from;
  double target_away_mm = 0.0;  ///< Range 0..200.
  std::optional<LandmarkZone> landmark_zone;
  std::optional<EntryLevel> highest_entry;
  std::optional<BevelRule> bevel;
  std::vector<Tier> levels;  ///< The easiest first.
  std::string level;         ///< Name of the level whose numbers the task has; empty: its own.
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

/// The task with the time limit and the tolerances of one of its levels, given by its name or its number from 1. Error
/// (exit status 2): an unknown one, the message lists them; the task has a level already.
Result<Task> at_level(Task task, std::string_view name_or_number);
/// The level that a task has; nullptr: none.
const Tier* level_of(const Task& task) noexcept;

/// True if a label is the task's organ or target; its risk structure in the task (nullptr: none). A risk that is named
/// by its tissue excludes organ and target: a biopsy of the pancreas can have "organ" as a risk.
bool is_organ(const Task& task, const anatomy::Label& label) noexcept;
bool is_target(const Task& task, const anatomy::Label& label) noexcept;
const RiskStructure* find_risk(const Task& task, const anatomy::Label& label) noexcept;

/// What a needle does to a label.
struct LabelHarm {
  Harm grade = Harm::kNone;
  Harm notch = Harm::kNone;  ///< If the specimen notch closes in it.
  Harm stay = Harm::kNone;   ///< If the needle stays in it for longer than `stay_s`.
  double stay_s = 0.0;
  std::string reason;  ///< What happens to the patient; may be empty.
};
/// In a task: organ and target are no harm, unless a risk names them by their label; then the first of the task's risks
/// with a harm of its own, of its rules, of the table's. A label that no row names is major harm (without a table:
/// minor if it is listed as a risk).
LabelHarm find_harm(const Task& task, const anatomy::Label& label);

/// The target lies in the organ's healthy tissue: no label of the patient is a target, or the task's point is in none.
bool is_parenchymal(const Task& task, const anatomy::VirtualPatient& patient);

/// Checks if a patient supports a task; lists missing and doubtful requirements.
struct TaskReadiness {
  bool is_possible = false;
  bool is_parenchymal = false;  ///< No lesion: the target is in the organ's healthy tissue.
  /// In which the task is done, if the patient lies otherwise in the scan; found by check_task_and_paths.
  std::optional<anatomy::Posture> posture;
  std::vector<std::string> reasons;  ///< Reasons why it is not possible, or findings.
};
TaskReadiness check_task(const Task& task, const anatomy::VirtualPatient& patient);

}  // namespace trocar::tasks
