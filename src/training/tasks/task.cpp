#include "tasks/task.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "core/text.h"
#include "tasks/detail/block_grid.h"
#include "tasks/fit_to_patient.h"

namespace trocar::tasks {
namespace {

/// Number of voxels of each label, and the labels at the border of the volume.
struct LabelCounts {
  std::array<std::size_t, 256> voxels{};
  std::array<bool, 256> touches_border{};
};

LabelCounts count_labels(const volume::LabelGrid& labels) {
  LabelCounts counts;
  const volume::Index3 size = labels.geometry.size;
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

/// Structures of a task that a patient has.
struct Inventory {
  bool has_organ = false;
  bool has_target = false;
  bool has_muscle = false;
  bool has_vessel = false;
  bool is_organ_cut = false;
};

Inventory take_inventory(const Task& task, const anatomy::VirtualPatient& patient, const LabelCounts& counts) {
  Inventory found;
  for (const anatomy::Label& label : patient.label_table.labels) {
    if (counts.voxels[label.id] == 0) continue;
    found.has_organ |= is_organ(task, label);
    found.has_target |= is_target(task, label);
    found.has_muscle |= label.tissue == "muscle";
    found.has_vessel |= label.tissue == "vessel";
    found.is_organ_cut |= is_organ(task, label) && counts.touches_border[label.id];
  }
  return found;
}

/// Risk structures of the task that are not labelled in the patient.
std::vector<std::string> unlabelled_risks(const Task& task, const anatomy::VirtualPatient& patient,
                                          const LabelCounts& counts) {
  std::vector<std::string> missing;
  for (const RiskStructure& risk : task.risks) {
    if (risk.is_optional) continue;
    const bool is_there = std::any_of(
        patient.label_table.labels.begin(), patient.label_table.labels.end(), [&](const anatomy::Label& label) {
          return counts.voxels[label.id] > 0 &&
                 (risk.tissue.empty() ? label.name == risk.label : label.tissue == risk.tissue);
        });
    if (!is_there) missing.push_back(risk.tissue.empty() ? risk.label : risk.tissue);
  }
  return missing;
}

/// The organ is not in the scan, or its segmentation lacks it: what the segmentation has, the largest first, tells
/// which part of the body it is. What was derived from it, or found from HU, is not listed.
std::string lacks_organ(const Task& task, const anatomy::VirtualPatient& patient, const LabelCounts& counts) {
  constexpr std::size_t kMostNamed = 12;
  std::vector<const anatomy::Label*> labels;
  for (const anatomy::Label& label : patient.label_table.labels) {
    // These are everywhere.
    const bool is_everywhere = label.tissue == "adipose" || label.tissue == "muscle" || label.tissue == "soft_tissue" ||
                               label.tissue == "gas" || label.tissue == "skin";
    if (counts.voxels[label.id] > 0 && !label.is_derived && !is_everywhere) labels.push_back(&label);
  }
  std::stable_sort(labels.begin(), labels.end(),
                   [&](const auto* a, const auto* b) { return counts.voxels[a->id] > counts.voxels[b->id]; });
  std::vector<std::string> names;
  for (const anatomy::Label* label : labels)
    if (names.size() < kMostNamed) names.push_back(label->name);
  if (labels.size() > kMostNamed) names.push_back(fmt::format("{} more", labels.size() - kMostNamed));
  return fmt::format("the {} is not labelled: the scan does not show it, or the segmentation lacks it (labelled: {})",
                     task.organ, names.empty() ? "no organ" : fmt::format("{}", fmt::join(names, ", ")));
}

}  // namespace

const char* to_string(ImagingModality guidance) noexcept {
  switch (guidance) {
    case ImagingModality::kUltrasound:
      return "ultrasound";
    case ImagingModality::kXray:
      return "xray";
    case ImagingModality::kPalpation:
      return "palpation";
  }
  return "";
}

double EntryZone::distance_outside_mm(const Vec3& p_P) const noexcept {
  return std::max(0.0, (p_P - centre_P).norm() - radius_mm);
}

bool is_organ(const Task& task, const anatomy::Label& label) noexcept {
  return label.tissue == task.organ || label.name == task.organ;
}

bool is_target(const Task& task, const anatomy::Label& label) noexcept {
  if (!task.target_label.empty()) return label.name == task.target_label;
  return std::find(task.target_tissues.begin(), task.target_tissues.end(), label.tissue) != task.target_tissues.end();
}

const RiskStructure* find_risk(const Task& task, const anatomy::Label& label) noexcept {
  const bool is_wanted = is_organ(task, label) || is_target(task, label);
  const auto it = std::find_if(task.risks.begin(), task.risks.end(), [&](const RiskStructure& risk) {
    return risk.tissue.empty() ? label.name == risk.label : !is_wanted && label.tissue == risk.tissue;
  });
  return it != task.risks.end() ? &*it : nullptr;
}

LabelHarm find_harm(const Task& task, const anatomy::Label& label) {
  const RiskStructure* const risk = find_risk(task, label);
  if (risk != nullptr && risk->harm) return {*risk->harm, *risk->harm, *risk->harm, 0.0, {}};
  if (is_organ(task, label) || is_target(task, label)) return {};
  const std::string plain = anatomy::without_side(anatomy::plain_name(label.name));
  for (const HarmRule& rule : task.harms)
    if (rule.is_for(task.target_tissues) && rule.matches(plain, label.tissue))
      return {rule.grade, rule.notch.value_or(rule.grade), rule.stay.value_or(rule.grade), rule.stay_s, rule.reason};
  if (!task.harms.empty()) return {Harm::kMajor, Harm::kMajor, Harm::kMajor, 0.0, "it is not known what it is"};
  const Harm grade = risk != nullptr ? Harm::kMinor : Harm::kNone;
  return {grade, grade, grade, 0.0, {}};
}

bool is_parenchymal(const Task& task, const anatomy::VirtualPatient& patient) {
  if (task.target_P) {
    const anatomy::Label* label = anatomy::find_label(patient, *task.target_P);
    return label == nullptr || !is_target(task, *label);
  }
  const auto& voxels = patient.labels.voxels;
  const auto& labels = patient.label_table.labels;
  return std::none_of(labels.begin(), labels.end(), [&](const anatomy::Label& label) {
    return is_target(task, label) && !voxels.empty() && std::memchr(voxels.data(), label.id, voxels.size()) != nullptr;
  });
}

TaskReadiness check_task(const Task& task, const anatomy::VirtualPatient& patient) {
  const LabelCounts counts = count_labels(patient.labels);
  const Inventory found = take_inventory(task, patient, counts);
  TaskReadiness readiness;
  const auto note = [&](bool is_true, const std::string& text) {
    if (is_true) readiness.reasons.push_back(text);
  };
  const bool has_skin = std::any_of(patient.skin_distance_mm.voxels.begin(), patient.skin_distance_mm.voxels.end(),
                                    [](float distance) { return distance > 0.0F; });
  const std::string shortage = found.has_organ ? detail::target_shortage(task, patient) : std::string();
  readiness.is_possible = found.has_organ && found.has_muscle && has_skin && shortage.empty();
  note(!shortage.empty(), shortage);
  if (!found.has_organ) note(true, lacks_organ(task, patient, counts));
  note(!found.has_muscle, "no muscle between skin and organ is labelled");
  note(!has_skin, "the skin's surface is not inside the volume");
  if (!readiness.is_possible) return readiness;

  readiness.is_parenchymal = is_parenchymal(task, patient);
  note(!task.target_label.empty() && !found.has_target,
       fmt::format("the target \"{}\" is not labelled", task.target_label));
  note(readiness.is_parenchymal && !task.target_P && task.target_label.empty(),
       fmt::format("{}: the target is in healthy {}, at least {} mm below its surface and {} mm from vessels",
                   task.target_tissues.empty() ? "the task has no target tissue" : "no lesion is labelled", task.organ,
                   task.parenchymal_depth_mm, task.parenchymal_vessel_mm));
  note(found.is_organ_cut, fmt::format("the {} is cut by the border of the volume", task.organ));
  note(!found.has_vessel, "doubtful: vessels are not labelled, so paths do not avoid them");
  std::vector<std::string> missing = unlabelled_risks(task, patient, counts);
  std::erase(missing, "vessel");
  note(!missing.empty(), fmt::format("not labelled, so paths do not avoid them: {}", fmt::join(missing, ", ")));
  for (const std::string& rule : unserved_rules(task, patient)) note(true, "doubtful: " + rule);
  return readiness;
}

Result<Task> at_level(Task task, std::string_view name_or_number) {
  if (!task.level.empty())
    return fail_usage(fmt::format("the task {} has the level \"{}\" already", task.name, task.level),
                      std::string(name_or_number), "name a task without a level");
  auto found = std::ranges::find(task.levels, name_or_number, &Tier::name);
  const auto number = parse_number<int>(name_or_number);
  if (found == task.levels.end() && number && *number >= 1 && *number <= static_cast<int>(task.levels.size()))
    found = task.levels.begin() + (*number - 1);
  if (found == task.levels.end()) {
    std::vector<std::string> known;
    for (const Tier& level : task.levels) known.push_back(fmt::format("{} {}", known.size() + 1, level.name));
    return fail_usage(fmt::format("the task {} has no level \"{}\"", task.name, name_or_number), {},
                      known.empty() ? std::string("add [[levels]] to its file")
                                    : fmt::format("known are: {}", fmt::join(known, ", ")));
  }
  const Tier& level = *found;
  task.level = level.name;
  task.breathing_mm = level.breathing_mm.value_or(task.breathing_mm);
  if (level.time_limit_s > 0.0) task.time_limit_s = level.time_limit_s;
  for (double* const tolerance :
       {&task.target_tolerance_mm, &task.entry_tolerance_mm, &task.angle_tolerance_deg, &task.margin_tolerance_mm})
    *tolerance *= level.tolerance_share;
  return task;
}

const Tier* level_of(const Task& task) noexcept {
  const auto found = std::ranges::find(task.levels, task.level, &Tier::name);
  return !task.level.empty() && found != task.levels.end() ? &*found : nullptr;
}

}  // namespace trocar::tasks
