#include "case_builder/case_history.h"

#include <utility>

namespace trocar::case_builder {

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

}  // namespace trocar::case_builder
