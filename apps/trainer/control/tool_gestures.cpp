#include "control/tool_gestures.h"

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <QWidget>
#include <cmath>

namespace trocar::trainer {
namespace {

constexpr double kTilt_rad_per_px = 0.0026;
constexpr double kNotch_mm = 1.0, kFineNotch_mm = 0.1;
constexpr double kKeyGlide_mm = 1.0, kKeyTilt_rad = 0.0175;
constexpr double kNotchAngle = 120.0;  // eighths of a degree, as Qt counts

QPointF position(const QMouseEvent& event) {
#if QT_VERSION >= QT_VERSION_CHECK(6, 0, 0)
  return event.globalPosition();
#else
  return event.screenPos();
#endif
}

}  // namespace

ToolGestures::ToolGestures(QObject* parent) : QObject(parent) {}

void ToolGestures::watch(QWidget& view, std::function<ViewScale()> scale) {
  watched_.push_back({&view, std::move(scale)});
  view.installEventFilter(this);
  for (QWidget* inside : view.findChildren<QWidget*>()) inside->installEventFilter(this);
}

void ToolGestures::watch_keys(QWidget& page) {
  page_ = &page;
  page.installEventFilter(this);
}

void ToolGestures::unwatch() {
  if (page_ != nullptr) page_->removeEventFilter(this);
  page_ = nullptr;
  for (const Watched& watched : watched_) {
    watched.view->removeEventFilter(this);
    for (QWidget* inside : watched.view->findChildren<QWidget*>()) inside->removeEventFilter(this);
  }
  watched_.clear();
  from_px_.reset();
}

void ToolGestures::take(ToolInHand tool) {
  in_hand_ = tool;
  from_px_.reset();
  Q_EMIT taken(tool);
}

const ToolGestures::Watched* ToolGestures::find(const QObject* object) const {
  const auto* widget = qobject_cast<const QWidget*>(object);
  for (const Watched& watched : watched_)
    if (widget == watched.view || (widget != nullptr && watched.view->isAncestorOf(widget))) return &watched;
  return nullptr;
}

bool ToolGestures::eventFilter(QObject* object, QEvent* event) {
  if (event->type() == QEvent::KeyPress && (object == page_ || find(object) != nullptr))
    return strike(static_cast<const QKeyEvent&>(*event));
  const Watched* watched = find(object);
  if (watched == nullptr) return false;
  const bool is_view = in_hand_ == ToolInHand::kNone || (QApplication::keyboardModifiers() & Qt::ControlModifier) ||
                       watched->scale().mm_per_px <= 0.0;
  switch (event->type()) {
    case QEvent::MouseButtonPress:
      return !is_view && press(static_cast<const QMouseEvent&>(*event));
    case QEvent::MouseMove:
      return move(*watched, static_cast<const QMouseEvent&>(*event));
    case QEvent::MouseButtonRelease:
      if (!from_px_) return false;
      from_px_.reset();
      return true;
    case QEvent::Wheel:
      return !is_view && turn(*watched, static_cast<const QWheelEvent&>(*event));
    default:
      return false;
  }
}

bool ToolGestures::press(const QMouseEvent& event) {
  if (event.button() == Qt::MiddleButton) return false;
  from_px_ = position(event);
  return true;
}

bool ToolGestures::move(const Watched& watched, const QMouseEvent& event) {
  if (!from_px_) return false;
  const QPointF by = position(event) - *from_px_;
  from_px_ = position(event);
  const ViewScale view = watched.scale();
  if (event.buttons() & Qt::RightButton) {
    const bool is_turn = QApplication::keyboardModifiers() & Qt::ShiftModifier;
    Q_EMIT gestured({is_turn ? Gesture::Kind::kTurn : Gesture::Kind::kTilt, kTilt_rad_per_px * by.x(),
                     is_turn ? 0.0 : kTilt_rad_per_px * by.y(), view});
  } else {
    Q_EMIT gestured({Gesture::Kind::kGlide, view.mm_per_px * by.x(), view.mm_per_px * by.y(), view});
  }
  return true;
}

bool ToolGestures::turn(const Watched& watched, const QWheelEvent& event) {
  // With Shift some systems turn the wheel sideways.
  const QPoint angle = event.angleDelta();
  const double notches = (angle.y() != 0 ? angle.y() : angle.x()) / kNotchAngle;
  const bool is_fine = QApplication::keyboardModifiers() & Qt::ShiftModifier;
  Q_EMIT gestured({Gesture::Kind::kPush, notches * (is_fine ? kFineNotch_mm : kNotch_mm), 0.0, watched.scale()});
  return true;
}

bool ToolGestures::strike(const QKeyEvent& event) {
  if (event.modifiers() & (Qt::ControlModifier | Qt::AltModifier)) return false;
  const bool is_tilt = event.modifiers() & Qt::ShiftModifier;
  const ViewScale view = watched_.empty() ? ViewScale{} : watched_.front().scale();
  const auto step = [&](double right, double down) {
    if (in_hand_ == ToolInHand::kNone) return false;
    const double size = is_tilt ? kKeyTilt_rad : kKeyGlide_mm;
    Q_EMIT gestured({is_tilt ? Gesture::Kind::kTilt : Gesture::Kind::kGlide, size * right, size * down, view});
    return true;
  };
  const auto push = [&](double sign) {
    if (in_hand_ == ToolInHand::kNone) return false;
    Q_EMIT gestured({Gesture::Kind::kPush, sign * (is_tilt ? kFineNotch_mm : kNotch_mm), 0.0, view});
    return true;
  };
  switch (event.key()) {
    case Qt::Key_A:
      take(ToolInHand::kNeedle);
      return true;
    case Qt::Key_S:
      take(ToolInHand::kTransducer);
      return true;
    case Qt::Key_V:
      take(ToolInHand::kNone);
      return true;
    case Qt::Key_Left:
      return step(-1.0, 0.0);
    case Qt::Key_Right:
      return step(1.0, 0.0);
    case Qt::Key_Up:
      return step(0.0, -1.0);
    case Qt::Key_Down:
      return step(0.0, 1.0);
    case Qt::Key_PageUp:
      return push(1.0);
    case Qt::Key_PageDown:
      return push(-1.0);
    case Qt::Key_H:
    case Qt::Key_X:
    case Qt::Key_E:
    case Qt::Key_Return:
    case Qt::Key_Enter:
      Q_EMIT key_struck(event.key());
      return true;
    default:
      return false;
  }
}

}  // namespace trocar::trainer
