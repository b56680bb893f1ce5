#include "authoring/case_history.h"

#include <utility>

namespace trocar {

void CaseHistory::begin(CaseDraft draft) {
  draft_ = std::move(draft);
  undone_by_.clear();
  redone_by_.clear();
  gesture_.clear();
  ++version_;
}

void CaseHistory::apply(CaseDraft next, std::string what, const std::string& gesture) {
  if (is_same_draft(next, draft_)) return;
  const bool is_continued = !gesture.empty() && gesture == gesture_ && can_undo();
  if (!is_continued) undone_by_.push_back({std::move(what), std::move(draft_)});
  if (undone_by_.size() > kMaxSteps) undone_by_.pop_front();
  draft_ = std::move(next);
  redone_by_.clear();
  gesture_ = gesture;
  ++version_;
}

void CaseHistory::undo() {
  if (!can_undo()) return;
  Step step = std::move(undone_by_.back());
  undone_by_.pop_back();
  std::swap(step.other, draft_);
  redone_by_.push_back(std::move(step));
  gesture_.clear();
  ++version_;
}

void CaseHistory::redo() {
  if (!can_redo()) return;
  Step step = std::move(redone_by_.back());
  redone_by_.pop_back();
  std::swap(step.other, draft_);
  undone_by_.push_back(std::move(step));
  gesture_.clear();
  ++version_;
}

}  // namespace trocar
