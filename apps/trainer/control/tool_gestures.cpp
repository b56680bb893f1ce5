#include "control/tool_gestures.h"

#include <QApplication>
#include <QMouseEvent>
#include <QWheelEvent>
#include <QWidget>
#include <algorithm>
#include <cmath>

namespace trocar::trainer {
namespace {

constexpr double kTilt_rad_per_px = 0.0026;
constexpr double kNotch_mm = 1.0, kFineNotch_mm = 0.1;
constexpr double kKeyGlide_mm = 1.0, kKeyTilt_rad = 0.0175;
constexpr double kNotchAngle = 120.0;  // eighths of a degree, as in Qt

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

void ToolGestures::unwatch() {
  for (const Watched& watched : watched_) {
    watched.view->removeEventFilter(this);
    for (QWidget* inside : watched.view->findChildren<QWidget*>()) inside->removeEventFilter(this);
  }
  watched_.clear();
  from_px_.reset();
}

void ToolGestures::take(ActiveTool tool) {
  active_tool_ = tool;
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
  const Watched* watched = find(object);
  if (watched == nullptr) return false;
  const bool is_view = active_tool_ == ActiveTool::kNone || active_tool_ == ActiveTool::kFinger ||
                       (QApplication::keyboardModifiers() & Qt::ControlModifier) || watched->scale().mm_per_px <= 0.0;
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
  // With Shift, some systems report a horizontal wheel.
  const QPoint angle = event.angleDelta();
  const double notches = (angle.y() != 0 ? angle.y() : angle.x()) / kNotchAngle;
  const bool is_fine = QApplication::keyboardModifiers() & Qt::ShiftModifier;
  Q_EMIT gestured({Gesture::Kind::kPush, notches * (is_fine ? kFineNotch_mm : kNotch_mm), 0.0, watched.scale()});
  return true;
}

/// True if a watched view has the focus: arrow and page keys then move the tool.
bool ToolGestures::has_focus() const {
  return std::any_of(watched_.begin(), watched_.end(), [](const Watched& watched) {
    const QWidget* focus = watched.view->window()->focusWidget();
    return focus == watched.view || (focus != nullptr && watched.view->isAncestorOf(focus));
  });
}

/// Sets the focus to a view, so that arrow keys move the tool instead of a list or slider.
bool ToolGestures::take_by_key(ActiveTool tool) {
  take(tool);
  if (!watched_.empty() && !has_focus()) watched_.front().view->setFocus(Qt::ShortcutFocusReason);
  return true;
}

bool ToolGestures::move_by_key(const FoundAction& found) {
  if (active_tool_ == ActiveTool::kNone) return false;
  constexpr QPointF kDirections[] = {{-1.0, 0.0}, {1.0, 0.0}, {0.0, -1.0}, {0.0, 1.0}};  // as the table's keys
  const ViewScale view = watched_.empty() ? ViewScale{} : watched_.front().scale();
  const auto step = [&](Gesture::Kind kind, double size) {
    const QPointF by = size * kDirections[found.key];
    Q_EMIT gestured({kind, by.x(), by.y(), view});
    return true;
  };
  const auto push = [&](double size_mm) {
    Q_EMIT gestured({Gesture::Kind::kPush, found.key == 0 ? size_mm : -size_mm, 0.0, view});
    return true;
  };
  switch (found.action) {
    case Action::kMove:
      return step(Gesture::Kind::kGlide, kKeyGlide_mm);
    case Action::kTilt:
      return step(Gesture::Kind::kTilt, kKeyTilt_rad);
    case Action::kAdvance:
      return push(kNotch_mm);
    case Action::kAdvanceFinely:
      return push(kFineNotch_mm);
    default:
      return false;
  }
}

bool ToolGestures::handle_action(const FoundAction& found, const KeyPlace& place) {
  switch (found.action) {
    case Action::kSelectNeedle:
      return take_by_key(ActiveTool::kNeedle);
    case Action::kSelectTransducer:
      return take_by_key(ActiveTool::kTransducer);
    case Action::kSelectFinger:
      return take_by_key(ActiveTool::kFinger);
    case Action::kSelectView:
      return take_by_key(ActiveTool::kNone);
    default:
      // Arrow keys also move sliders, lists and slices.
      return (place.is_unclaimed || has_focus()) && move_by_key(found);
  }
}

}  // namespace trocar::trainer
