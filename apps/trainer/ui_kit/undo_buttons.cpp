#include "ui_kit/undo_buttons.h"

#include <QBoxLayout>
#include <QShortcut>
#include <QToolButton>

#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

QToolButton* make_undo_button(const char* prefix, const char* what, const QString& sign, const QString& text,
                              Action action, QWidget& panel, const std::function<void()>& act) {
  const QString name = QStringLiteral("%1-%2").arg(QLatin1String(prefix), QLatin1String(what));
  const QString tooltip = QWidget::tr("%1  (%2 in this panel)").arg(text, keys_text(action));
  QToolButton* button = make_tool_button(qPrintable(name), sign, tooltip);
  button->setAccessibleName(text);
  button->setFocusPolicy(Qt::StrongFocus);
  QObject::connect(button, &QToolButton::clicked, &panel, act);
  auto* shortcut = new QShortcut(key_of(action), &panel);
  shortcut->setContext(Qt::WidgetWithChildrenShortcut);
  QObject::connect(shortcut, &QShortcut::activated, &panel, act);
  return button;
}

}  // namespace

UndoButtons::UndoButtons(const char* prefix, QWidget& panel, const std::function<void()>& undo,
                         const std::function<void()>& redo)
    : undo_(make_undo_button(prefix, "undo", QStringLiteral("⤺"), QWidget::tr("Undo"), Action::kUndoHere, panel, undo)),
      redo_(
          make_undo_button(prefix, "redo", QStringLiteral("⤻"), QWidget::tr("Redo"), Action::kRedoHere, panel, redo)) {}

void UndoButtons::add_to(QBoxLayout& layout) {
  layout.addWidget(undo_);
  layout.addWidget(redo_);
}

void UndoButtons::show(bool can_undo, bool can_redo) {
  if (undo_->isEnabled() != can_undo) undo_->setEnabled(can_undo);
  if (redo_->isEnabled() != can_redo) redo_->setEnabled(can_redo);
}

}  // namespace trocar::trainer
