#include "case_builder/case_draft.h"

#include <algorithm>

namespace trocar {
namespace {

bool is_same_label(const Label& a, const Label& b) {
  return a.id == b.id && a.name == b.name && a.tissue == b.tissue && a.color == b.color;
}
bool is_same_landmark(const Landmark& a, const Landmark& b) {
  return a.name == b.name && a.p_P == b.p_P;
}
bool is_same_path(const NeedlePath& a, const NeedlePath& b) {
  return a.name == b.name && a.line_P.a == b.line_P.a && a.line_P.b == b.line_P.b;
}

}  // namespace

bool is_same_draft(const CaseDraft& a, const CaseDraft& b) {
  return a.imported == b.imported && a.name == b.name && a.description == b.description &&
         a.provenance == b.provenance && a.base.name == b.base.name &&
         std::equal(a.label_table.labels.begin(), a.label_table.labels.end(), b.label_table.labels.begin(),
                    b.label_table.labels.end(), is_same_label) &&
         std::equal(a.landmarks.begin(), a.landmarks.end(), b.landmarks.begin(), b.landmarks.end(), is_same_landmark) &&
         std::equal(a.paths.begin(), a.paths.end(), b.paths.begin(), b.paths.end(), is_same_path) &&
         task_to_toml(a.task, Task{}) == task_to_toml(b.task, Task{});
}

const NeedlePath* find_expert_path(const CaseDraft& draft) noexcept {
  if (draft.task.expert_path.empty()) return nullptr;
  const auto found = std::find_if(draft.paths.begin(), draft.paths.end(),
                                  [&](const NeedlePath& path) { return path.name == draft.task.expert_path; });
  return found != draft.paths.end() ? &*found : nullptr;
}

std::optional<Vec3> find_target_point(const CaseDraft& draft) {
  if (draft.task.target_P) return draft.task.target_P;
  if (!draft.imported) return std::nullopt;
  const LabelStatistics* largest = nullptr;
  for (const LabelStatistics& s : draft.imported->statistics) {
    const Label* label = draft.label_table.find(s.id);
    if (label == nullptr || s.voxels == 0 || !is_target(draft.task, *label)) continue;
    if (largest == nullptr || s.voxels > largest->voxels) largest = &s;
  }
  if (largest == nullptr) return std::nullopt;
  return largest->centroid_P;
}

}  // namespace trocar
