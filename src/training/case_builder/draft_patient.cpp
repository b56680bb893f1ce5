#include "case_builder/draft_patient.h"

#include <algorithm>

#include "core/check.h"

namespace trocar::case_builder {
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

}  // namespace trocar::case_builder
