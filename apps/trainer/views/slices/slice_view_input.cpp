// Mouse, wheel and keys of the slice viewer.
#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "ui_kit/action_table.h"
#include "views/slices/slice_view.h"
#include "views/view_strip.h"

namespace trocar::trainer {
namespace {

constexpr double kClick = 4.0;        ///< Maximum motion of a click in points.
constexpr double kWheelStep = 120.0;  ///< angleDelta of one step; finer wheels send fractions.
constexpr double kZoomStep = 1.15;
constexpr double kNearestZoom_mm_per_px = 0.02;  ///< Nearest zoom: size of a device pixel.
constexpr double kFarthestZoom_mm_per_px = 10.0;
constexpr double kArrow_mm = 1.0, kFarArrow_mm = 10.0;
constexpr double kPanStep = 16.0;  ///< Points per arrow key.

}  // namespace

bool SliceView::event(QEvent* event) {
  // A tool tip over the picture would hide it.
  if (event->type() == QEvent::ToolTip && static_cast<QHelpEvent*>(event)->pos().y() > picture_rect().top())
    return true;
  // With the focus here, the slice's keys take precedence over shortcuts of the window.
  if (event->type() == QEvent::ShortcutOverride) {
    const auto found = find_action(Scope::kSlices, static_cast<QKeyEvent&>(*event));
    if (found && has_use_for(*found)) {
      event->accept();
      return true;
    }
  }
  return QWidget::event(event);
}

void SliceView::changeEvent(QEvent* event) {
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) update();
  QWidget::changeEvent(event);
}

void SliceView::resizeEvent(QResizeEvent* /*event*/) {
  strip_->follow_view();
  update_size();
}

void SliceView::move_focus(const Vec3& p_P) {
  if (p_P == focus_P_) return;
  focus_P_ = p_P;
  if (!follows_needle()) move_plane_to_anchor();
  update();
  Q_EMIT focus_moved(p_P);
}

void SliceView::pan_by(const QPointF& points) {
  is_fitted_ = false;
  const double mm = geometry_.mm_per_px * device_pixel_ratio_;
  geometry_.center_P -= mm * (points.x() * geometry_.axes.u_P + points.y() * geometry_.axes.v_P);
  is_stale_ = true;
  update();
}

void SliceView::zoom_at(const QPointF& position, double factor) {
  is_fitted_ = false;
  geometry_.zoom_at(to_pixel(position),
                    std::clamp(geometry_.mm_per_px / factor, kNearestZoom_mm_per_px, kFarthestZoom_mm_per_px));
  is_stale_ = true;
  update();
}

double SliceView::slice_step_mm() const {
  if (!patient_) return 1.0;
  const volume::GridGeometry& grid = patient_->ct.geometry;
  const Vec3 voxels_per_mm = (grid.R_PV.transpose() * geometry_.axes.normal_P()).cwiseQuotient(grid.spacing_mm);
  return 1.0 / voxels_per_mm.cwiseAbs().maxCoeff();
}

void SliceView::scroll(double slices) {
  const double way_mm = slices * slice_step_mm();
  if (!follows_needle()) return move_focus(focus_P_ + way_mm * geometry_.axes.normal_P());
  offset_mm_ += way_mm;
  if (std::abs(offset_mm_) < 1e-6) offset_mm_ = 0.0;  // back at the tip: removes rounding errors
  move_plane_to_anchor();
  update();
}

void SliceView::change_window(const slices::Window& window) {
  const slices::Window before = style_.window;
  set_window(window.center_hu, window.width_hu);
  if (!(style_.window == before)) Q_EMIT window_changed(style_.window.center_hu, style_.window.width_hu);
}

void SliceView::mousePressEvent(QMouseEvent* event) {
  const QPointF position = event->pos();
  if (!patient_ || drag_ != Drag::kNone || !picture_rect().contains(position)) return;
  const bool has_shift = event->modifiers().testFlag(Qt::ShiftModifier);
  if (event->button() == Qt::MiddleButton || (event->button() == Qt::LeftButton && has_shift))
    drag_ = Drag::kPan;
  else if (event->button() == Qt::LeftButton)
    drag_ = Drag::kFocus;
  else if (event->button() == Qt::RightButton)
    drag_ = Drag::kWindow;
  pressed_at_ = dragged_to_ = position;
  is_click_ = drag_ == Drag::kFocus;
  if (drag_ == Drag::kFocus) move_focus(point_at(position));
  if (drag_ == Drag::kPan) setCursor(Qt::ClosedHandCursor);
}

void SliceView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF position = event->pos();
  const QPointF moved = position - dragged_to_;
  dragged_to_ = position;
  const QPointF from_press = position - pressed_at_;
  if (std::hypot(from_press.x(), from_press.y()) > kClick) is_click_ = false;
  switch (drag_) {
    case Drag::kNone:
      return;
    case Drag::kFocus:
      return move_focus(point_at(position));
    case Drag::kPan:
      return pan_by(moved);
    case Drag::kWindow:
      break;
  }
  // Wide windows change fast, narrow ones slowly.
  const double hu_per_point = std::max(1.0, style_.window.width_hu / 200.0);
  change_window({style_.window.center_hu + hu_per_point * moved.y(),
                 std::max(1.0, style_.window.width_hu + hu_per_point * moved.x())});
}

void SliceView::mouseReleaseEvent(QMouseEvent* event) {
  if (drag_ == Drag::kNone) return;
  // Another button may have been pressed and released during the drag.
  const Qt::MouseButtons needed = drag_ == Drag::kFocus    ? Qt::MouseButtons(Qt::LeftButton)
                                  : drag_ == Drag::kWindow ? Qt::MouseButtons(Qt::RightButton)
                                                           : Qt::LeftButton | Qt::MiddleButton;
  if ((event->buttons() & needed) != 0) return;
  drag_ = Drag::kNone;
  setCursor(Qt::CrossCursor);
  if (std::exchange(is_click_, false)) Q_EMIT clicked(point_at(pressed_at_));
}

void SliceView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (!patient_ || event->button() != Qt::LeftButton || !picture_rect().contains(event->pos())) return;
  pan_by(picture_rect().center() - QPointF(event->pos()));
}

void SliceView::wheelEvent(QWheelEvent* event) {
  if (!patient_) return;
  const double steps = event->angleDelta().y() / kWheelStep;
  if (event->modifiers().testFlag(Qt::ControlModifier))
    zoom_at(event->position(), std::pow(kZoomStep, steps));
  else
    scroll(steps);
  event->accept();
}

bool SliceView::has_use_for(const FoundAction& found) const {
  const bool is_of_ct = found.action == Action::kWindowPreset || found.action == Action::kLabels;
  return patient_ != nullptr && !(is_ultrasound() && is_of_ct);
}

void SliceView::keyPressEvent(QKeyEvent* event) {
  const auto found = find_action(Scope::kSlices, *event);
  if (!found || !has_use_for(*found)) return QWidget::keyPressEvent(event);
  const auto arrow = [&](double way_mm) {
    constexpr double kDirections[][2] = {{-1.0, 0.0}, {1.0, 0.0}, {0.0, -1.0}, {0.0, 1.0}};  // as the table's keys
    const auto [right, down] = kDirections[found->key];
    if (follows_needle()) return pan_by(-kPanStep * QPointF(right, down));
    const slices::SliceAxes& axes = geometry_.axes;
    move_focus(focus_P_ + way_mm * (right * axes.u_P + down * axes.v_P));
    follow_anchor();
  };
  const bool is_minus = event->key() == Qt::Key_Minus;
  switch (found->action) {
    case Action::kMoveFocus:
      return arrow(kArrow_mm);
    case Action::kMoveFocusFar:
      return arrow(kFarArrow_mm);
    case Action::kScrollSlices:
      return scroll(found->key == 0 ? 1.0 : -1.0);
    case Action::kZoomSlice:
      return zoom_at(position_of(anchor_P()), is_minus ? 1.0 / kZoomStep : kZoomStep);
    case Action::kWindowPreset:
      return change_window(slices::kWindowPresets[static_cast<std::size_t>(found->key)].window);
    case Action::kLabels:
      return set_labels_visible(!has_labels_);
    default:
      return reset();
  }
}

}  // namespace trocar::trainer
