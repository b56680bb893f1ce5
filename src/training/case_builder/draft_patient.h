#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "case_builder/case_draft.h"

namespace trocar::case_builder {

/// The patient of a draft. With unedited labels it is the import itself; with edited labels the first request copies
/// the volumes: call it from a worker thread. Caches the newest one.
class DraftPatient {
 public:
  /// With the draft's label table; landmarks, paths and texts are those of the import. The draft must have an import.
  std::shared_ptr<const anatomy::VirtualPatient> of(const CaseDraft& draft);
  /// The same if no labels must be copied; otherwise null.
  std::shared_ptr<const anatomy::VirtualPatient> find(const CaseDraft& draft) const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const ImportedPatient> of_import_;
  std::shared_ptr<const anatomy::VirtualPatient> edited_;
};

/// Surfaces with the current names of their labels; those of the import itself if no name was changed.
std::shared_ptr<const std::vector<anatomy::NamedMesh>> draft_meshes(const CaseDraft& draft);

}  // namespace trocar::case_builder
