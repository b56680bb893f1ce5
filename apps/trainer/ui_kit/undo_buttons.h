#pragma once

#include <functional>

class QBoxLayout;
class QToolButton;
class QWidget;

namespace trocar::trainer {

/// Undo and redo buttons of a panel, with their keys while the focus is in the panel: Ctrl+Z, Ctrl+Shift+Z. Object
/// names: PREFIX-undo, PREFIX-redo.
class UndoButtons {
 public:
  UndoButtons(const char* prefix, QWidget& panel, const std::function<void()>& undo, const std::function<void()>& redo);
  void add_to(QBoxLayout& layout);
  void show(bool can_undo, bool can_redo);

 private:
  QToolButton* undo_;
  QToolButton* redo_;
};

}  // namespace trocar::trainer
