#include "training/task.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/toml.h"

namespace trocar {
namespace fs = std::filesystem;
namespace {

Result<RiskStructure> read_risk(const TomlTable& row) {
  TROCAR_TRY_STATUS(row.check_keys({"tissue", "label", "margin_mm", "penalty"}));
  RiskStructure risk;
  TROCAR_TRY(risk.tissue, row.string_or("tissue", ""));
  TROCAR_TRY(risk.label, row.string_or("label", ""));
  if (risk.tissue.empty() == risk.label.empty())
    return fail("a risk structure is named by its tissue or its label", row.where(), "give one of the two");
  TROCAR_TRY(risk.margin_mm, row.number("margin_mm", {0.0, 50.0}));
  TROCAR_TRY(risk.penalty, row.number("penalty", {0.0, 100.0}));
  return risk;
}

Status read_path(const TomlTable& document, Task& task) {
  TROCAR_TRY(const TomlTable path, document.table("path"));
  TROCAR_TRY_STATUS(path.check_keys({"min_organ_path_mm", "max_path_mm", "max_entry_angle_deg", "max_posterior_deg"}));
  TROCAR_TRY(task.min_organ_path_mm, path.number("min_organ_path_mm", {0.0, 50.0}));
  TROCAR_TRY(task.max_path_mm, path.number("max_path_mm", {10.0, 300.0}));
  TROCAR_TRY(task.max_entry_angle_deg, path.number("max_entry_angle_deg", {5.0, 85.0}));
  TROCAR_TRY(task.max_posterior_deg, path.number("max_posterior_deg", {0.0, 90.0}));
  TROCAR_TRY(const TomlTable parenchymal, document.table("parenchymal"));
  TROCAR_TRY_STATUS(parenchymal.check_keys({"depth_mm", "vessel_mm"}));
  TROCAR_TRY(task.parenchymal_depth_mm, parenchymal.number("depth_mm", {0.0, 100.0}));
  TROCAR_TRY(task.parenchymal_vessel_mm, parenchymal.number("vessel_mm", {0.0, 50.0}));
  return {};
}

Status read_scoring(const TomlTable& document, Task& task) {
  TROCAR_TRY(const TomlTable scoring, document.table("scoring"));
  TROCAR_TRY_STATUS(
      scoring.check_keys({"target_tolerance_mm", "entry_tolerance_mm", "angle_tolerance_deg", "time_limit_s"}));
  TROCAR_TRY(task.target_tolerance_mm, scoring.number("target_tolerance_mm", {0.1, 100.0}));
  TROCAR_TRY(task.entry_tolerance_mm, scoring.number("entry_tolerance_mm", {0.1, 200.0}));
  TROCAR_TRY(task.angle_tolerance_deg, scoring.number("angle_tolerance_deg", {0.1, 90.0}));
  TROCAR_TRY(task.time_limit_s, scoring.number("time_limit_s", {1.0, 3600.0}));
  return {};
}

Result<Task> read_task(const fs::path& path) {
  TROCAR_TRY(const TomlTable document, load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys(
      {"title", "organ", "target_tissues", "needle", "force_model", "path", "parenchymal", "scoring", "risks"}));
  Task task;
  task.name = path.stem().string();
  TROCAR_TRY(task.title, document.string("title"));
  TROCAR_TRY(task.organ, document.string("organ"));
  TROCAR_TRY(task.target_tissues, document.strings("target_tissues"));
  TROCAR_TRY(task.needle, document.string("needle"));
  TROCAR_TRY(task.force_model, document.string_or("force_model", task.force_model));
  TROCAR_TRY_STATUS(read_path(document, task));
  TROCAR_TRY_STATUS(read_scoring(document, task));
  TROCAR_TRY(const std::vector<TomlTable> risks, document.tables("risks"));
  for (const TomlTable& row : risks) {
    TROCAR_TRY(RiskStructure risk, read_risk(row));
    task.risks.push_back(std::move(risk));
  }
  return task;
}

Result<std::vector<fs::path>> task_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".toml") files.push_back(it->path());
  if (error)
    return fail("the tasks cannot be listed: " + error.message(), folder.string(),
                "set TROCAR_DATA_DIR to the folder data");
  std::sort(files.begin(), files.end());
  return files;
}

/// How often each label occurs, and which labels lie on the border of the volume.
struct LabelCounts {
  std::array<std::size_t, 256> voxels{};
  std::array<bool, 256> touches_border{};
};

LabelCounts count_labels(const LabelGrid& labels) {
  LabelCounts counts;
  const Index3 size = labels.geometry.size;
  std::size_t n = 0;
  for (std::int64_t k = 0; k < size[2]; ++k)
    for (std::int64_t j = 0; j < size[1]; ++j) {
      const bool is_border_row = k == 0 || j == 0 || k == size[2] - 1 || j == size[1] - 1;
      for (std::int64_t i = 0; i < size[0]; ++i, ++n) {
        const std::uint8_t id = labels.voxels[n];
        ++counts.voxels[id];
        if (is_border_row || i == 0 || i == size[0] - 1) counts.touches_border[id] = true;
      }
    }
  return counts;
}

/// What a patient has of a task's structures.
struct Inventory {
  bool has_organ = false;
  bool has_target = false;
  bool has_muscle = false;
  bool has_vessel = false;
  bool is_organ_cut = false;
};

Inventory take_inventory(const Task& task, const VirtualPatient& patient, const LabelCounts& counts) {
  Inventory found;
  for (const Label& label : patient.label_table.labels) {
    if (counts.voxels[label.id] == 0) continue;
    found.has_organ |= is_organ(task, label);
    found.has_target |= is_target(task, label);
    found.has_muscle |= label.tissue == "muscle";
    found.has_vessel |= label.tissue == "vessel";
    found.is_organ_cut |= is_organ(task, label) && counts.touches_border[label.id];
  }
  return found;
}

/// Risk structures of the task that the patient does not show.
std::vector<std::string> unlabelled_risks(const Task& task, const VirtualPatient& patient, const LabelCounts& counts) {
  std::vector<std::string> missing;
  for (const RiskStructure& risk : task.risks) {
    const bool is_there =
        std::any_of(patient.label_table.labels.begin(), patient.label_table.labels.end(), [&](const Label& label) {
          return counts.voxels[label.id] > 0 &&
                 (risk.tissue.empty() ? label.name == risk.label : label.tissue == risk.tissue);
        });
    if (!is_there) missing.push_back(risk.tissue.empty() ? risk.label : risk.tissue);
  }
  return missing;
}

}  // namespace

bool is_organ(const Task& task, const Label& label) noexcept {
  return label.tissue == task.organ || label.name == task.organ;
}

bool is_target(const Task& task, const Label& label) noexcept {
  return std::find(task.target_tissues.begin(), task.target_tissues.end(), label.tissue) != task.target_tissues.end();
}

const RiskStructure* find_risk(const Task& task, const Label& label) noexcept {
  const auto it = std::find_if(task.risks.begin(), task.risks.end(), [&](const RiskStructure& risk) {
    return risk.tissue.empty() ? label.name == risk.label : label.tissue == risk.tissue;
  });
  return it != task.risks.end() ? &*it : nullptr;
}

Result<std::vector<Task>> load_tasks(const fs::path& tasks_folder) {
  TROCAR_TRY(const std::vector<fs::path> files, task_files(tasks_folder));
  std::vector<Task> tasks;
  for (const fs::path& file : files) {
    TROCAR_TRY(Task task, read_task(file));
    tasks.push_back(std::move(task));
  }
  return tasks;
}

Result<Task> load_task(const fs::path& tasks_folder, std::string_view name) {
  TROCAR_TRY(const std::vector<fs::path> files, task_files(tasks_folder));
  std::vector<std::string> names;
  for (const fs::path& file : files) {
    if (file.stem().string() == name) return read_task(file);
    names.push_back(file.stem().string());
  }
  return fail_usage(fmt::format("there is no task \"{}\"", name), tasks_folder.string(),
                    fmt::format("known are: {}", fmt::join(names, ", ")));
}

TaskReadiness check_task(const Task& task, const VirtualPatient& patient) {
  const LabelCounts counts = count_labels(patient.labels);
  const Inventory found = take_inventory(task, patient, counts);
  TaskReadiness readiness;
  const auto note = [&](bool is_true, std::string text) {
    if (is_true) readiness.reasons.push_back(std::move(text));
  };
  const bool has_skin = std::any_of(patient.skin_distance_mm.voxels.begin(), patient.skin_distance_mm.voxels.end(),
                                    [](float distance) { return distance > 0.0F; });
  readiness.is_possible = found.has_organ && found.has_muscle && has_skin;
  note(!found.has_organ, fmt::format("no {} is labelled", task.organ));
  note(!found.has_muscle, "no muscle between skin and organ is labelled");
  note(!has_skin, "the skin's surface is not inside the volume");
  if (!readiness.is_possible) return readiness;

  readiness.is_parenchymal = !found.has_target;
  note(readiness.is_parenchymal,
       fmt::format(
           "no lesion is labelled: the target lies in healthy {}, at least {} mm below its surface and {} mm from "
           "vessels",
           task.organ, task.parenchymal_depth_mm, task.parenchymal_vessel_mm));
  note(found.is_organ_cut, fmt::format("the {} is cut by the border of the volume", task.organ));
  note(!found.has_vessel, "doubtful: no vessels are labelled, so none are avoided");
  std::vector<std::string> missing = unlabelled_risks(task, patient, counts);
  std::erase(missing, "vessel");
  note(!missing.empty(), fmt::format("not labelled, so not avoided: {}", fmt::join(missing, ", ")));
  return readiness;
}

}  // namespace trocar
