#pragma once

#include <QObject>
#include <functional>
#include <optional>

#include "ui_kit/action_table.h"

class QAbstractButton;
class QKeyEvent;
class QWidget;

namespace trocar::trainer {

/// The widget with the focus when a key is pressed.
struct KeyPlace {
  bool is_text = false;               ///< A text field or a number field.
  bool is_aside = false;              ///< A menu, an open list or a dialog.
  bool takes_space = false;           ///< A button, a list or a choice.
  bool is_choice = false;             ///< A list, a choice or a slider, in which keys choose.
  bool is_unclaimed = false;          ///< No widget has handled the key.
  QAbstractButton* button = nullptr;  ///< Null if it is not a button.
};

/// Of the widget with the focus, for a receiver of keys of its own.
KeyPlace key_place();
/// False where a key that acts on the patient must not: somebody who types or chooses did not mean it.
inline bool may_act(const KeyPlace& place) noexcept {
  return !place.is_text && !place.is_aside && !place.is_choice;
}

/// Receives each key of a window and its floating views before the focused widget, so that page keys work with any
/// focus. `take` returns true if it has handled the key; it is called again with is_unclaimed for a key that no widget
/// has handled.
class PageKeys : public QObject {
  Q_OBJECT

 public:
  using Take = std::function<bool(const QKeyEvent& key, const KeyPlace& place)>;

  PageKeys(QWidget& page, Take take);
  ~PageKeys() override;

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  QWidget& page_;
  Take take_;
  /// Time of a key that was pressed in an open list or menu, from its override event to its release: Qt closes the list
  /// at the override and gives the key itself to the widget below.
  std::optional<unsigned long> pressed_aside_;
};

enum class KeyVerdict {
  kPass,     ///< The widget with the focus gets the key.
  kPerform,  ///< The page acts.
  kIgnore,   ///< Nobody gets it.
  kRefuse,   ///< Nobody gets it, and the user is told why.
};
/// What becomes of the key of an action. One that acts on the patient is refused where somebody types or chooses, and
/// does not repeat while it is held; Enter goes to a list that has a use for it.
KeyVerdict judge_key(const ActionRow& row, const QKeyEvent& key, const KeyPlace& place);

/// Space stops the forces; therefore Enter presses the button with the focus. False: another key, or no button.
bool press_focused_button(const QKeyEvent& key, const KeyPlace& place);
/// For Enter where it means `action`, whose button is `button`: presses the button with the focus, else this one. True
/// if the key is handled; not while somebody types, or in a dialog.
bool press_by_enter(const QKeyEvent& key, const KeyPlace& place, Action action, QAbstractButton& button);

}  // namespace trocar::trainer
