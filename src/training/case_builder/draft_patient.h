#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "case_builder/case_draft.h"

namespace trocar::case_builder {

/// A draft's patient as all other parts want it. While the labels are as imported it is the import itself; with edited
/// labels the volumes have to be copied once, whichever thread asks first: ask on a thread of its own. Keeps the
/// newest.
class DraftPatient {
 public:
  /// With the draft's label table; landmarks, paths and texts are those of the import. The draft must have an import.
  std::shared_ptr<const anatomy::VirtualPatient> of(const CaseDraft& draft);
  /// The same where it costs nothing; null where labels would have to be copied first.
  std::shared_ptr<const anatomy::VirtualPatient> find(const CaseDraft& draft) const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const ImportedPatient> of_import_;
  std::shared_ptr<const anatomy::VirtualPatient> edited_;
};

/// The surfaces by the names that their labels have now; those of the import itself where no name was changed.
std::shared_ptr<const std::vector<anatomy::NamedMesh>> draft_meshes(const CaseDraft& draft);

}  // namespace trocar::case_builder
