#pragma once

#include <cstdint>
#include <string>

#include "case_builder/case_draft.h"
#include "core/step_history.h"

namespace trocar::case_builder {

/// The draft with its undo and redo steps. At most kMaxSteps are kept, some kilobytes each; the volumes of the import
/// are shared. A new import begins a new history, so that no more than one import is held.
class CaseHistory {
 public:
  static constexpr std::size_t kMaxSteps = 200;

  const CaseDraft& draft() const noexcept { return steps_.now().draft; }
  /// Counts every change of the draft, undo and redo included.
  std::uint64_t version() const noexcept { return version_; }

  /// Removes all steps and starts with `draft`.
  void begin(CaseDraft draft);
  /// Adds one step. `what`: text for the buttons. Consecutive steps with the same `gesture` (a drag, a spin box) are
  /// merged; empty: a separate step. A draft without a change adds no step.
  void apply(CaseDraft next, std::string what, const std::string& gesture = {});

  bool can_undo() const noexcept { return steps_.can_undo(); }
  bool can_redo() const noexcept { return steps_.can_redo(); }
  std::string undo_text() const { return can_undo() ? steps_.now().what : std::string(); }
  std::string redo_text() const { return can_redo() ? steps_.next().what : std::string(); }
  void undo();  ///< No effect if there is nothing to undo.
  void redo();

 private:
  struct Step {
    CaseDraft draft;
    std::string what;  ///< Text of the step that led to it.
  };
  StepHistory<Step> steps_{kMaxSteps};
  std::string gesture_;
  std::uint64_t version_ = 0;
};

}  // namespace trocar::case_builder
