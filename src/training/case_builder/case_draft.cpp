#include "case_builder/case_draft.h"

#include <algorithm>
#include <utility>

#include "cases/scene_request.h"
#include "core/result.h"

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

void CaseHistory::begin(CaseDraft draft) {
  steps_.begin({std::move(draft), {}});
  gesture_.clear();
  ++version_;
}

void CaseHistory::apply(CaseDraft next, std::string what, const std::string& gesture) {
  if (is_same_draft(next, draft())) return;
  const bool is_continued = !gesture.empty() && gesture == gesture_ && can_undo();
  if (is_continued) what = steps_.now().what;
  steps_.step_to({std::move(next), std::move(what)}, is_continued);
  gesture_ = gesture;
  ++version_;
}

void CaseHistory::undo() {
  if (!can_undo()) return;
  steps_.undo();
  gesture_.clear();
  ++version_;
}

void CaseHistory::redo() {
  if (!can_redo()) return;
  steps_.redo();
  gesture_.clear();
  ++version_;
}

namespace {

bool is_same_table(const anatomy::LabelTable& a, const anatomy::LabelTable& b) {
  return std::equal(a.labels.begin(), a.labels.end(), b.labels.begin(), b.labels.end(),
                    [](const anatomy::Label& x, const anatomy::Label& y) {
                      return x.id == y.id && x.name == y.name && x.tissue == y.tissue && x.color == y.color;
                    });
}

std::shared_ptr<const anatomy::VirtualPatient> as_imported(const CaseDraft& draft) {
  if (!is_same_table(draft.label_table, draft.imported->patient.label_table)) return nullptr;
  return {draft.imported, &draft.imported->patient};
}

}  // namespace

std::shared_ptr<const anatomy::VirtualPatient> DraftPatient::find(const CaseDraft& draft) const {
  if (!draft.imported) return nullptr;
  if (auto patient = as_imported(draft)) return patient;
  const std::lock_guard lock(mutex_);
  if (of_import_ == draft.imported && edited_ && is_same_table(edited_->label_table, draft.label_table)) return edited_;
  return nullptr;
}

std::shared_ptr<const anatomy::VirtualPatient> DraftPatient::of(const CaseDraft& draft) {
  TROCAR_CHECK(draft.imported != nullptr);
  if (auto patient = find(draft)) return patient;
  auto edited = std::make_shared<anatomy::VirtualPatient>(draft.imported->patient);
  edited->label_table = draft.label_table;
  const std::lock_guard lock(mutex_);
  of_import_ = draft.imported;
  edited_ = edited;
  return edited;
}

std::shared_ptr<const std::vector<anatomy::NamedMesh>> draft_meshes(const CaseDraft& draft) {
  if (!draft.imported) return std::make_shared<const std::vector<anatomy::NamedMesh>>();
  const auto& before = draft.imported->patient.label_table.labels;
  const auto& now = draft.label_table.labels;
  if (std::equal(before.begin(), before.end(), now.begin(), now.end(),
                 [](const anatomy::Label& a, const anatomy::Label& b) { return a.id == b.id && a.name == b.name; }))
    return {draft.imported, &draft.imported->meshes};
  auto meshes = std::make_shared<std::vector<anatomy::NamedMesh>>(draft.imported->meshes);
  for (anatomy::NamedMesh& mesh : *meshes) {
    const anatomy::Label* old_label = draft.imported->patient.label_table.find(std::string_view(mesh.name));
    const anatomy::Label* label = old_label != nullptr ? draft.label_table.find(old_label->id) : nullptr;
    if (label != nullptr) mesh.name = label->name;
  }
  return meshes;
}

namespace {

constexpr double kSpeed_mm_per_s = 10.0;
constexpr double kMostLag_mm = 20.0;  ///< Behind the device by the compliance of tissue and coupling.

}  // namespace

Result<ForcePreview> preview_forces(const CaseDraft& draft, std::shared_ptr<const anatomy::VirtualPatient> patient,
                                    const tasks::Needle& needle, const anatomy::TissueTable& tissues) {
  const anatomy::NeedlePath* path = find_expert_path(draft);
  if (path == nullptr) return fail("no expert path is drawn", draft.name, "draw one, or have one planned");
  haptics::HapticOptions options;
  options.has_weight_compensation = false;
  TROCAR_TRY(options.force_model, haptics::parse_force_model(draft.task.force_model));
  TROCAR_TRY(const auto scene,
             haptics::make_haptic_scene(std::move(patient), tissues, cases::needle_geometry(needle), {}, options));
  cases::PrescribedMotion motion;
  motion.line_P = path->line_P;
  motion.speed_mm_per_s = kSpeed_mm_per_s;
  motion.after_mm = kMostLag_mm;
  ForcePreview preview;
  preview.curve = cases::force_curve(*scene, motion);
  preview.events = cases::find_curve_events(preview.curve, tissues);
  preview.pieces = cases::pieces_along(*scene, tissues, path->line_P);
  for (const cases::CurvePoint& point : preview.curve) preview.highest_n = std::max(preview.highest_n, point.force_n);
  return preview;
}

}  // namespace trocar::case_builder
