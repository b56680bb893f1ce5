#include "case_builder/case_draft.h"

#include <algorithm>

namespace trocar::case_builder {
namespace {

bool is_same_label(const anatomy::Label& a, const anatomy::Label& b) {
  return a.id == b.id && a.name == b.name && a.tissue == b.tissue && a.color == b.color;
}
bool is_same_landmark(const anatomy::Landmark& a, const anatomy::Landmark& b) {
  return a.name == b.name && a.p_P == b.p_P;
}
bool is_same_path(const anatomy::NeedlePath& a, const anatomy::NeedlePath& b) {
  return a.name == b.name && a.line_P.a == b.line_P.a && a.line_P.b == b.line_P.b;
}

bool is_same_point(const registration::NamedPoint& a, const registration::NamedPoint& b) {
  return a.name == b.name && a.p == b.p;
}
bool is_same_ultrasound(const CaseDraft& a, const CaseDraft& b) {
  const bool is_same_pose =
      a.placement.has_value() == b.placement.has_value() &&
      (!a.placement || (a.placement->X_PU.p() == b.placement->X_PU.p() &&
                        a.placement->X_PU.R() == b.placement->X_PU.R() && a.placement->origin == b.placement->origin));
  return a.ultrasound == b.ultrasound && is_same_pose &&
         std::equal(a.ultrasound_landmarks.begin(), a.ultrasound_landmarks.end(), b.ultrasound_landmarks.begin(),
                    b.ultrasound_landmarks.end(), is_same_point);
}

}  // namespace

bool is_same_draft(const CaseDraft& a, const CaseDraft& b) {
  return a.imported == b.imported && a.name == b.name && a.description == b.description &&
         a.provenance == b.provenance && a.base.name == b.base.name &&
         std::equal(a.label_table.labels.begin(), a.label_table.labels.end(), b.label_table.labels.begin(),
                    b.label_table.labels.end(), is_same_label) &&
         std::equal(a.landmarks.begin(), a.landmarks.end(), b.landmarks.begin(), b.landmarks.end(), is_same_landmark) &&
         std::equal(a.paths.begin(), a.paths.end(), b.paths.begin(), b.paths.end(), is_same_path) &&
         is_same_ultrasound(a, b) && task_to_toml(a.task, tasks::Task{}) == task_to_toml(b.task, tasks::Task{});
}

const anatomy::NeedlePath* find_expert_path(const CaseDraft& draft) noexcept {
  if (draft.task.expert_path.empty()) return nullptr;
  const auto found = std::find_if(draft.paths.begin(), draft.paths.end(),
                                  [&](const anatomy::NeedlePath& path) { return path.name == draft.task.expert_path; });
  return found != draft.paths.end() ? &*found : nullptr;
}

std::optional<Vec3> find_target_point(const CaseDraft& draft) {
  if (draft.task.target_P) return draft.task.target_P;
  if (!draft.imported) return std::nullopt;
  const anatomy::LabelStatistics* largest = nullptr;
  for (const anatomy::LabelStatistics& s : draft.imported->statistics) {
    const anatomy::Label* label = draft.label_table.find(s.id);
    if (label == nullptr || s.voxels == 0 || !tasks::is_target(draft.task, *label)) continue;
    if (largest == nullptr || s.voxels > largest->voxels) largest = &s;
  }
  if (largest == nullptr) return std::nullopt;
  return largest->centroid_P;
}

}  // namespace trocar::case_builder
