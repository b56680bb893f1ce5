#include "ui_kit/window_mirror.h"

#include <QApplication>
#include <QGraphicsEffect>
#include <QMainWindow>
#include <QMouseEvent>
#include <QPainter>
#include <QPixmap>
#include <QWheelEvent>
#include <QWidget>
#include <QWindow>
#include <algorithm>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

/// Draws a widget with its contents, mirrored.
class TurnOver : public QGraphicsEffect {
 public:
  TurnOver(MirrorAxis axis, QString text) : axis_(axis), text_(std::move(text)) {}

 protected:
  void draw(QPainter* painter) override {
    QPoint offset;
    const QPixmap picture = sourcePixmap(Qt::LogicalCoordinates, &offset, NoPad);
    const QSizeF size = QSizeF(picture.size()) / picture.devicePixelRatio();
    const QRectF box(offset, size);
    painter->save();
    painter->translate(box.center());
    painter->scale(axis_ == MirrorAxis::kLeftRight ? -1.0 : 1.0, axis_ == MirrorAxis::kUpDown ? -1.0 : 1.0);
    painter->translate(-box.center());
    painter->drawPixmap(box.topLeft(), picture);
    painter->restore();
    if (!text_.isEmpty()) draw_text(*painter, box);
  }

 private:
  /// Text for users who look at the screen directly.
  void draw_text(QPainter& painter, const QRectF& box) const {
    painter.setFont(scaled_font(0.85, true));
    const QRectF line = painter.fontMetrics().boundingRect(text_).adjusted(-8, -3, 8, 3);
    const QRectF place(box.center().x() - 0.5 * line.width(), box.top(), line.width(), line.height());
    painter.fillRect(place, theme().warning);
    painter.setPen(theme().ground);
    painter.drawText(place, Qt::AlignCenter, text_);
  }

  MirrorAxis axis_;
  QString text_;
};

#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
/// The copy stays "spontaneous", as required for focus by click and for tool tips.
struct TurnedMouseEvent : QMouseEvent {
  TurnedMouseEvent(const QMouseEvent& event, const QPointF& place, const QPointF& global) : QMouseEvent(event) {
    l = w = place;
    s = global;
  }
};
struct TurnedWheelEvent : QWheelEvent {
  TurnedWheelEvent(const QWheelEvent& event, const QPointF& place, const QPointF& global) : QWheelEvent(event) {
    p = place;
    g = global;
  }
};
QPointF event_place_of(const QMouseEvent& event) {
  return event.localPos();
}
#else
struct TurnedMouseEvent : QMouseEvent {
  TurnedMouseEvent(const QMouseEvent& event, const QPointF& place, const QPointF& global)
      : QMouseEvent(event.type(), place, place, global, event.button(), event.buttons(), event.modifiers()) {}
};
struct TurnedWheelEvent : QWheelEvent {
  TurnedWheelEvent(const QWheelEvent& event, const QPointF& place, const QPointF& global)
      : QWheelEvent(place, global, event.pixelDelta(), event.angleDelta(), event.buttons(), event.modifiers(),
                    event.phase(), event.inverted()) {}
};
QPointF event_place_of(const QSinglePointEvent& event) {
  return event.position();
}
#endif
QPointF event_place_of(const QWheelEvent& event) {
  return event.position();
}

}  // namespace

WindowMirror::WindowMirror(QMainWindow& window, QString back_text)
    : QObject(&window), window_(window), back_text_(std::move(back_text)) {}

WindowMirror::~WindowMirror() = default;

void WindowMirror::set_axis(MirrorAxis axis) {
  if (axis == axis_) return;
  turn_back();
  axis_ = axis;
  if (axis == MirrorAxis::kNone) return qApp->removeEventFilter(this);
  qApp->installEventFilter(this);
  turn_over(*window_.centralWidget());
  for (QWidget* top : QApplication::topLevelWidgets())
    if (top != &window_ && top->isVisible()) turn_over(*top);
}

void WindowMirror::turn_over(QWidget& widget) {
  const bool is_main = &widget == window_.centralWidget();
  widget.setGraphicsEffect(new TurnOver(axis_, is_main ? back_text_ : QString()));
  turned_.push_back(&widget);
}

void WindowMirror::turn_back() {
  for (const QPointer<QWidget>& widget : turned_)
    if (widget) widget->setGraphicsEffect(nullptr);
  turned_.clear();
}

QPointF WindowMirror::turned(const QPointF& place, const QSizeF& size) const {
  return {axis_ == MirrorAxis::kLeftRight ? size.width() - place.x() : place.x(),
          axis_ == MirrorAxis::kUpDown ? size.height() - place.y() : place.y()};
}

int WindowMirror::row_on_screen(int global_row) const {
  if (axis_ != MirrorAxis::kUpDown) return global_row;
  return 2 * window_.geometry().top() + window_.height() - 1 - global_row;
}

/// Moves a popup from the position chosen by Qt to that in the mirrored window.
void WindowMirror::put_in_place(QWidget& popup) const {
  const QRectF window = window_.geometry();
  const QRectF box = popup.geometry();
  const QPointF far_corner = turned(box.bottomRight() - window.topLeft(), window.size());
  const QPointF near_corner = turned(box.topLeft() - window.topLeft(), window.size());
  const QPointF corner(std::min(far_corner.x(), near_corner.x()), std::min(far_corner.y(), near_corner.y()));
  popup.move((window.topLeft() + corner).toPoint());
}

bool WindowMirror::forward(QWindow& window, QEvent& event) {
  const auto send = [&](auto& original, auto make) {
    const QPointF place = turned(event_place_of(original), window.size());
    auto copy = make(original, place, QPointF(window.mapToGlobal(QPoint(0, 0))) + place);
    copy.setTimestamp(original.timestamp());
    is_forwarding_ = true;
    qApp->notify(&window, &copy);  // sendEvent would clear the flag of a window system event
    is_forwarding_ = false;
    original.setAccepted(copy.isAccepted());
    return true;
  };
  switch (event.type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseMove:
      return send(static_cast<QMouseEvent&>(event), [](const QMouseEvent& e, const QPointF& place, const QPointF& at) {
        return TurnedMouseEvent(e, place, at);
      });
    case QEvent::Wheel:
      return send(static_cast<QWheelEvent&>(event), [](const QWheelEvent& e, const QPointF& place, const QPointF& at) {
        return TurnedWheelEvent(e, place, at);
      });
    default:
      return false;
  }
}

bool WindowMirror::eventFilter(QObject* receiver, QEvent* event) {
  if (receiver->isWindowType()) return !is_forwarding_ && forward(static_cast<QWindow&>(*receiver), *event);
  if (event->type() == QEvent::Show && receiver->isWidgetType()) {
    auto& widget = static_cast<QWidget&>(*receiver);
    if (widget.isWindow() && &widget != &window_) {
      if (widget.graphicsEffect() == nullptr) turn_over(widget);
      put_in_place(widget);
    }
  }
  return false;
}

}  // namespace trocar::trainer
