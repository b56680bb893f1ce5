#pragma once

#include <QObject>
#include <QPointF>
#include <QPointer>
#include <vector>

class QEvent;
class QMainWindow;
class QWidget;
class QWindow;

namespace trocar::trainer {

/// Mirror axis of a monitor's image that is viewed in a mirror.
enum class MirrorAxis {
  kNone,
  kLeftRight,
  kUpDown,
};

/// Mirrors everything that the program displays, so that it is correct in a mirror: the window, its menus, lists,
/// tooltips and dialogs. Both their contents and their positions about the centre of the window are mirrored. Pointer
/// events are mirrored before widgets receive them, so that a click reaches the item drawn under the pointer. A line of
/// text that is not mirrored names the key that restores the window.
class WindowMirror : public QObject {
  Q_OBJECT

 public:
  /// `back_text`: the text of that line.
  WindowMirror(QMainWindow& window, QString back_text);
  ~WindowMirror() override;

  void set_axis(MirrorAxis axis);
  MirrorAxis axis() const noexcept { return axis_; }
  /// Screen row of a widget's row after mirroring, both in pixels.
  int row_on_screen(int global_row) const;

 protected:
  bool eventFilter(QObject* receiver, QEvent* event) override;

 private:
  bool forward(QWindow& window, QEvent& event);
  void turn_over(QWidget& widget);
  void turn_back();
  void put_in_place(QWidget& popup) const;
  QPointF turned(const QPointF& place, const QSizeF& size) const;

  QMainWindow& window_;
  const QString back_text_;
  MirrorAxis axis_ = MirrorAxis::kNone;
  bool is_forwarding_ = false;
  std::vector<QPointer<QWidget>> turned_;
};

}  // namespace trocar::trainer
