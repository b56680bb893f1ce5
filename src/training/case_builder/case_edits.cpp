#include "case_builder/case_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "case_builder/case_draft.h"
#include "patient_builder/plausibility/judge_anatomy.h"
#include "tasks/assess_path.h"

namespace trocar::case_builder {
namespace {

constexpr double kShortestPath_mm = 5.0;

Status check_imported(const CaseDraft& draft) {
  if (draft.imported) return {};
  return fail("there is no patient yet", {}, "import a CT with its labels first");
}

Status check_in_volume(const CaseDraft& draft, const Vec3& p_P, const char* what) {
  TROCAR_TRY_STATUS(check_imported(draft));
  return detail::check_in_volume(draft.imported->patient.labels.geometry, p_P, what, "move it into the patient");
}

Result<anatomy::Label*> find_label(CaseDraft& draft, std::uint8_t id) {
  for (anatomy::Label& label : draft.label_table.labels)
    if (label.id == id) return &label;
  return fail(fmt::format("there is no label {}", id), "label table", "choose a label of this case");
}

std::vector<anatomy::Landmark>::iterator find_landmark(CaseDraft& draft, const std::string& name) {
  return std::find_if(draft.landmarks.begin(), draft.landmarks.end(),
                      [&](const anatomy::Landmark& landmark) { return landmark.name == name; });
}

bool is_same_structure(const tasks::RiskStructure& a, const tasks::RiskStructure& b) {
  return a.tissue == b.tissue && a.label == b.label;
}

}  // namespace

Result<CaseDraft> rename_label(CaseDraft draft, std::uint8_t id, const std::string& name) {
  TROCAR_TRY(anatomy::Label * label, find_label(draft, id));
  if (name.empty()) return fail("a label needs a name", label->name, "type one");
  const anatomy::Label* other = draft.label_table.find(std::string_view(name));
  if (other != nullptr && other->id != id)
    return fail(fmt::format("another label is called \"{}\" already", name), label->name, "choose another name");
  for (tasks::RiskStructure& risk : draft.task.risks)
    if (!risk.label.empty() && risk.label == label->name) risk.label = name;
  if (draft.task.target_label == label->name) draft.task.target_label = name;
  label->name = name;
  return draft;
}

Result<CaseDraft> set_label_tissue(CaseDraft draft, std::uint8_t id, const std::string& tissue) {
  TROCAR_TRY(anatomy::Label * label, find_label(draft, id));
  if (tissue.empty()) return fail("a label needs a tissue", label->name, "choose one of the list");
  label->tissue = tissue;
  return draft;
}

Result<CaseDraft> set_label_color(CaseDraft draft, std::uint8_t id, const image::Rgb& color) {
  TROCAR_TRY(anatomy::Label * label, find_label(draft, id));
  label->color = color;
  return draft;
}

CaseDraft use_template(CaseDraft draft, const tasks::Task& base) {
  tasks::Task task = base;
  task.target_label = draft.task.target_label;
  task.target_P = draft.task.target_P;
  task.entry_zone = draft.task.entry_zone;
  task.expert_path = draft.task.expert_path;
  draft.base = base;
  draft.task = std::move(task);
  return draft;
}

Result<CaseDraft> set_target_point(CaseDraft draft, const Vec3& p_P) {
  TROCAR_TRY_STATUS(check_in_volume(draft, p_P, "target"));
  draft.task.target_P = p_P;
  return draft;
}

Result<CaseDraft> set_target_label(CaseDraft draft, const std::string& name) {
  if (!name.empty() && draft.label_table.find(std::string_view(name)) == nullptr)
    return fail(fmt::format("there is no label \"{}\"", name), {}, "choose one of the list");
  draft.task.target_label = name;
  draft.task.target_P.reset();
  return draft;
}

Result<CaseDraft> set_risk(CaseDraft draft, const tasks::RiskStructure& risk) {
  if (risk.tissue.empty() == risk.label.empty())
    return fail("a risk structure needs either a tissue or a label", {}, "give one of the two");
  if (!(risk.margin_mm >= 0.0 && risk.margin_mm <= 50.0))
    return fail("a margin is from 0 to 50 mm", fmt::format("{}", risk.margin_mm), "give a number in this range");
  auto& risks = draft.task.risks;
  const auto found = std::find_if(risks.begin(), risks.end(),
                                  [&](const tasks::RiskStructure& other) { return is_same_structure(other, risk); });
  if (found != risks.end()) {
    *found = risk;
  } else {
    risks.push_back(risk);
  }
  return draft;
}

Result<CaseDraft> remove_risk(CaseDraft draft, std::size_t row) {
  if (row >= draft.task.risks.size())
    return fail("there is no such risk structure", "risk structures", "choose a risk structure of the list");
  draft.task.risks.erase(draft.task.risks.begin() + static_cast<std::ptrdiff_t>(row));
  return draft;
}

Result<CaseDraft> set_entry_zone(CaseDraft draft, const Vec3& near_P, double radius_mm) {
  TROCAR_TRY_STATUS(check_imported(draft));
  if (!(radius_mm >= 1.0 && radius_mm <= 200.0))
    return fail("the radius of an entry zone is from 1 to 200 mm", fmt::format("{}", radius_mm),
                "give a number in this range");
  const auto centre_P = tasks::find_nearest_skin(draft.imported->patient, near_P);
  if (!centre_P) return fail("no skin near this position", {}, "click on the patient's skin");
  draft.task.entry_zone = tasks::EntryZone{*centre_P, radius_mm};
  return draft;
}

CaseDraft clear_entry_zone(CaseDraft draft) {
  draft.task.entry_zone.reset();
  return draft;
}

Result<CaseDraft> set_expert_path(CaseDraft draft, const Segment& line_P) {
  TROCAR_TRY_STATUS(check_in_volume(draft, line_P.a, "entry"));
  TROCAR_TRY_STATUS(check_in_volume(draft, line_P.b, "path's end"));
  if (!(line_P.length_mm() >= kShortestPath_mm))
    return fail(fmt::format("a path must be at least {:.0f} mm long", kShortestPath_mm), {}, "move its ends apart");
  if (draft.task.expert_path.empty()) draft.task.expert_path = kExpertPath;
  for (anatomy::NeedlePath& path : draft.paths) {
    if (path.name != draft.task.expert_path) continue;
    path.line_P = line_P;
    return draft;
  }
  draft.paths.insert(draft.paths.begin(), {draft.task.expert_path, line_P});
  return draft;
}

CaseDraft confirm_finding(CaseDraft draft, const patient_builder::AnatomyFinding& finding) {
  draft.provenance.push_back(patient_builder::confirmation(finding));
  return draft;
}

CaseDraft clear_expert_path(CaseDraft draft) {
  std::erase_if(draft.paths, [&](const anatomy::NeedlePath& path) { return path.name == draft.task.expert_path; });
  draft.task.expert_path.clear();
  return draft;
}

Result<CaseDraft> set_landmark(CaseDraft draft, const std::string& name, const Vec3& p_P) {
  TROCAR_TRY_STATUS(check_in_volume(draft, p_P, "landmark"));
  if (name.empty()) return fail("a landmark needs a name", {}, "choose or type one");
  const auto found = find_landmark(draft, name);
  if (found != draft.landmarks.end()) {
    found->p_P = p_P;
  } else {
    draft.landmarks.push_back({name, p_P});
  }
  return draft;
}

Result<CaseDraft> rename_landmark(CaseDraft draft, std::size_t row, const std::string& name) {
  if (row >= draft.landmarks.size())
    return fail("there is no such landmark", "landmarks", "choose a landmark of the list");
  anatomy::Landmark& landmark = draft.landmarks[row];
  if (name.empty()) return fail("a landmark needs a name", landmark.name, "type one");
  if (name != landmark.name && find_landmark(draft, name) != draft.landmarks.end())
    return fail(fmt::format("another landmark is called \"{}\" already", name), landmark.name, "choose another name");
  for (registration::NamedPoint& partner : draft.ultrasound_landmarks)
    if (partner.name == landmark.name) partner.name = name;
  landmark.name = name;
  return draft;
}

Result<CaseDraft> remove_landmark(CaseDraft draft, std::size_t row) {
  if (row >= draft.landmarks.size())
    return fail("there is no such landmark", "landmarks", "choose a landmark of the list");
  draft.landmarks.erase(draft.landmarks.begin() + static_cast<std::ptrdiff_t>(row));
  return draft;
}

std::span<const std::string_view> landmark_names() noexcept {
  static constexpr std::array<std::string_view, 25> kNames{"suprasternal notch",
                                                           "xiphoid process",
                                                           "right costal margin, mid-clavicular line",
                                                           "left costal margin, mid-clavicular line",
                                                           "right mid-axillary line, eighth intercostal space",
                                                           "right mid-axillary line, tenth rib",
                                                           "umbilicus",
                                                           "right anterior superior iliac spine",
                                                           "left anterior superior iliac spine",
                                                           "right iliac crest",
                                                           "left iliac crest",
                                                           "pubic symphysis",
                                                           "spinous process C7",
                                                           "spinous process T12",
                                                           "spinous process L1",
                                                           "spinous process L2",
                                                           "spinous process L3",
                                                           "spinous process L4",
                                                           "spinous process L5",
                                                           "interspinous space L3/L4",
                                                           "interspinous space L4/L5",
                                                           "right twelfth rib",
                                                           "left twelfth rib",
                                                           "right posterior superior iliac spine",
                                                           "left posterior superior iliac spine"};
  return kNames;
}

}  // namespace trocar::case_builder
