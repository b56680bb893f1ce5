#pragma once

#include <QIcon>
#include <QListWidget>
#include <optional>
#include <vector>

#include "case_builder/checks.h"

namespace trocar::trainer {

/// A tick, an exclamation mark or a cross in the level's colour; empty `level`: not checked yet.
QIcon level_icon(std::optional<case_builder::CheckLevel> level);

/// Checks of a case: passed, warnings and errors, worst first. A click or Enter shows the position and the step.
/// Object name: case-checks.
class CheckList : public QListWidget {
  Q_OBJECT

 public:
  explicit CheckList(QWidget* parent = nullptr);
  void show_checks(const std::vector<case_builder::CaseCheck>& checks);

 Q_SIGNALS:
  void check_chosen(const trocar::case_builder::CaseCheck& check);

 private:
  std::vector<case_builder::CaseCheck> checks_;
};

}  // namespace trocar::trainer
