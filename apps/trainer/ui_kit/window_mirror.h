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

/// How a monitor is turned over for who sees it in a mirror.
enum class MirrorAxis {
  kNone,
  kLeftRight,
  kUpDown,
};

/// Turns over everything that the program shows, so that it is right in a mirror: the window, its menus, lists, tips
/// and dialogs, each in itself and in its place about the middle of the window. Events of the pointer are turned over
/// before widgets get them, so that a click meets what is drawn under the pointer. A line that is not turned over says
/// which key leads back.
class WindowMirror : public QObject {
  Q_OBJECT

 public:
  /// `back_text`: that line.
  WindowMirror(QMainWindow& window, QString back_text);
  ~WindowMirror() override;

  void set_axis(MirrorAxis axis);
  MirrorAxis axis() const noexcept { return axis_; }
  /// Where a row of pixels of the screen is after turning over; rows of a widget as it is drawn.
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
