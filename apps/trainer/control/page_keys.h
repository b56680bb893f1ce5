#pragma once

#include <QObject>
#include <functional>

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
};

}  // namespace trocar::trainer
