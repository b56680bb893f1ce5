#include "ui_kit/page_keys.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractScrollArea>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QKeyEvent>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QTextEdit>

namespace trocar::trainer {
namespace {

bool is_text_field(const QWidget* widget) {
  if (const auto* line = qobject_cast<const QLineEdit*>(widget)) return !line->isReadOnly();
  if (const auto* box = qobject_cast<const QComboBox*>(widget)) return box->isEditable();
  if (const auto* text = qobject_cast<const QTextEdit*>(widget)) return !text->isReadOnly();
  if (const auto* text = qobject_cast<const QPlainTextEdit*>(widget)) return !text->isReadOnly();
  return qobject_cast<const QAbstractSpinBox*>(widget) != nullptr;
}

/// A floating view is a window whose parent belongs to the main window.
const QWidget* main_window_of(const QWidget& widget) {
  const QWidget* window = widget.window();
  while (window->parentWidget() != nullptr) window = window->parentWidget()->window();
  return window;
}

KeyPlace key_place_of(const QWidget& receiver, const QWidget& window) {
  QWidget* focus = receiver.window()->focusWidget();
  KeyPlace place;
  place.is_text = is_text_field(&receiver) || is_text_field(focus);
  place.is_aside = QApplication::activePopupWidget() != nullptr || QApplication::activeModalWidget() != nullptr;
  place.button = qobject_cast<QAbstractButton*>(focus);
  place.is_choice = qobject_cast<const QAbstractScrollArea*>(focus) != nullptr ||
                    qobject_cast<const QComboBox*>(focus) != nullptr ||
                    qobject_cast<const QAbstractSlider*>(focus) != nullptr;
  place.takes_space = place.button != nullptr || qobject_cast<const QAbstractItemView*>(focus) != nullptr ||
                      qobject_cast<const QComboBox*>(focus) != nullptr;
  place.is_unclaimed = &receiver == &window;
  return place;
}

}  // namespace

KeyPlace key_place() {
  const QWidget* focus = QApplication::focusWidget();
  if (focus != nullptr) return key_place_of(*focus, *focus->window());
  KeyPlace place;
  place.is_aside = QApplication::activePopupWidget() != nullptr || QApplication::activeModalWidget() != nullptr;
  return place;
}

PageKeys::PageKeys(QWidget& page, Take take) : page_(page), take_(std::move(take)) {
  QCoreApplication::instance()->installEventFilter(this);
}

PageKeys::~PageKeys() = default;

bool PageKeys::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    const unsigned long time = static_cast<const QKeyEvent*>(event)->timestamp();
    if (QApplication::activePopupWidget() != nullptr)
      pressed_aside_ = time;
    else if (pressed_aside_ != time)
      pressed_aside_.reset();
  }
  if (event->type() == QEvent::KeyRelease) pressed_aside_.reset();
  if (event->type() != QEvent::KeyPress) return false;
  const auto* receiver = qobject_cast<const QWidget*>(watched);
  if (receiver == nullptr || main_window_of(*receiver) != main_window_of(page_)) return false;
  const auto& key = static_cast<const QKeyEvent&>(*event);
  KeyPlace place = key_place_of(*receiver, *receiver->window());
  place.is_aside |= pressed_aside_ == key.timestamp();
  return take_(key, place);
}

KeyVerdict judge_key(const ActionRow& row, const QKeyEvent& key, const KeyPlace& place) {
  if (place.is_text || place.is_aside) return KeyVerdict::kPass;
  if (!row.acts_on_patient) return KeyVerdict::kPerform;
  const bool is_enter = key.key() == Qt::Key_Return || key.key() == Qt::Key_Enter;
  if (!may_act(place) && is_enter && !place.is_unclaimed) return KeyVerdict::kPass;
  if (key.isAutoRepeat()) return KeyVerdict::kIgnore;
  return may_act(place) ? KeyVerdict::kPerform : KeyVerdict::kRefuse;
}

bool press_focused_button(const QKeyEvent& key, const KeyPlace& place) {
  const bool is_enter = key.key() == Qt::Key_Return || key.key() == Qt::Key_Enter;
  if (!is_enter || place.button == nullptr || place.is_text || place.is_aside) return false;
  if (!key.isAutoRepeat()) place.button->click();
  return true;
}

bool press_by_enter(const QKeyEvent& key, const KeyPlace& place, Action action, QAbstractButton& button) {
  const auto found = find_action(row_of(action).scope, key, [action](Action other) { return other == action; });
  if (!found || !button.isVisible() || place.is_text || place.is_aside) return false;
  if (press_focused_button(key, place)) return true;
  if (!key.isAutoRepeat()) button.click();
  return true;
}

}  // namespace trocar::trainer
