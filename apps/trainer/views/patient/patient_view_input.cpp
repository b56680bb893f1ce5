#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "ui_kit/action_table.h"
#include "views/patient/patient_view.h"

namespace trocar::trainer {
namespace {

constexpr double kOrbit_rad_per_view = 3.6;  ///< A drag over the whole height.
constexpr double kZoomPerNotch = 1.15;
constexpr double kZoomPerView = 6.0;  ///< A drag over the whole height.
constexpr double kKeyOrbit_rad = 0.12;
constexpr double kWheelNotch = 120.0;  ///< Of QWheelEvent::angleDelta.
/// Position of a mouse event; the same in Qt 5 and Qt 6.
QPointF whole_place_of(const QMouseEvent& event) {
  return QPointF(event.pos());
}

void toggle(PatientView& view, scene::FollowMode mode) {
  view.set_follow(view.follow() == mode ? scene::FollowMode::kFree : mode);
}

void turn(PatientView& view, double right, double up) {
  view.set_view(scene::orbited(view.view(), right, up));
}

void act(PatientView& view, const FoundAction& found) {
  constexpr scene::CameraPreset kPresets[] = {
      scene::CameraPreset::kAnterior,  scene::CameraPreset::kRightAnteriorOblique,
      scene::CameraPreset::kRight,     scene::CameraPreset::kLeft,
      scene::CameraPreset::kPosterior, scene::CameraPreset::kCranial};
  constexpr double kTurns[][2] = {{-1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}};  // left, right, up, down
  switch (found.action) {
    case Action::kCameraPreset:
      return view.set_camera(kPresets[found.key]);
    case Action::kOrbit:
      return turn(view, kKeyOrbit_rad * kTurns[found.key][0], kKeyOrbit_rad * kTurns[found.key][1]);
    case Action::kZoom3d:
      return view.set_view(scene::zoomed(view.view(), found.key == 0 ? kZoomPerNotch : 1.0 / kZoomPerNotch));
    case Action::kFollowTip:
      return toggle(view, scene::FollowMode::kTip);
    case Action::kAlongNeedle:
      return toggle(view, scene::FollowMode::kAlongNeedle);
    case Action::kBesideNeedle:
      return toggle(view, scene::FollowMode::kSide);
    case Action::kGuidance:
      return view.set_guidance_visible(!view.is_guidance_visible());
    case Action::kLandmarks:
      return view.set_landmarks_visible(!view.are_landmarks_visible());
    default:
      return view.reset_camera();
  }
}

}  // namespace

QPointF PatientView::unmirrored(const QPointF& place) const {
  const scene::StereoOptions& options = stereo();
  return {options.is_mirrored_left_right ? width() - place.x() : place.x(),
          options.is_mirrored_up_down ? height() - place.y() : place.y()};
}

std::pair<Vec3, Vec3> PatientView::ray_at(const QPointF& place) const {
  const scene::CameraView& camera = view();
  const QPointF at = unmirrored(place);
  const double per_px = 2.0 * std::tan(0.5 * camera.view_angle_rad) / std::max(1, height());
  const Vec3 along_P = camera.forward_P() + per_px * (at.x() - 0.5 * width()) * camera.right_P() -
                       per_px * (at.y() - 0.5 * height()) * camera.up_P;
  return {camera.eye_P, along_P.normalized()};
}

QPointF PatientView::position_of(const Vec3& p_P) const {
  const scene::CameraView& camera = view();
  const double per_px = 2.0 * std::tan(0.5 * camera.view_angle_rad) / std::max(1, height());
  const Vec3 from_eye_P = p_P - camera.eye_P;
  const double depth_mm = std::max(1.0, from_eye_P.dot(camera.forward_P()));
  return unmirrored({0.5 * width() + from_eye_P.dot(camera.right_P()) / (depth_mm * per_px),
                     0.5 * height() - from_eye_P.dot(camera.up_P) / (depth_mm * per_px)});
}

void PatientView::wheelEvent(QWheelEvent* event) {
  const double notches = event->angleDelta().y() / kWheelNotch;
  set_view(scene::zoomed(view(), std::pow(kZoomPerNotch, notches)));
  event->accept();
}

void PatientView::mousePressEvent(QMouseEvent* event) {
  const bool has_shift = (event->modifiers() & Qt::ShiftModifier) != 0;
  drag_ = event->button() == Qt::LeftButton && has_shift ? Qt::MiddleButton : event->button();
  last_place_ = unmirrored(whole_place_of(*event));
  setFocus(Qt::MouseFocusReason);
}

void PatientView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF place = unmirrored(whole_place_of(*event));
  const QPointF moved = (place - last_place_) / std::max(1, height());
  last_place_ = place;
  if (drag_ == Qt::LeftButton)
    set_view(scene::orbited(view(), kOrbit_rad_per_view * moved.x(), -kOrbit_rad_per_view * moved.y()));
  if (drag_ == Qt::MiddleButton) set_view(scene::panned(view(), moved.x(), moved.y()));
  if (drag_ == Qt::RightButton) set_view(scene::zoomed(view(), std::pow(kZoomPerView, -moved.y())));
}

void PatientView::mouseReleaseEvent(QMouseEvent* /*event*/) {
  drag_ = Qt::NoButton;
}

void PatientView::mouseDoubleClickEvent(QMouseEvent* event) {
  const QPointF place = unmirrored(whole_place_of(*event));
  const auto p_P = scene().pick(place.x() / std::max(1, width()), place.y() / std::max(1, height()));
  if (p_P) Q_EMIT picked(*p_P);
}

void PatientView::keyPressEvent(QKeyEvent* event) {
  const auto found = find_action(Scope::kView3d, *event);
  if (!found) return QWidget::keyPressEvent(event);
  act(*this, *found);
  Q_EMIT changed();
}

/// With the focus here, the view's keys take precedence over shortcuts of the window.
bool PatientView::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride && find_action(Scope::kView3d, static_cast<QKeyEvent&>(*event))) {
    event->accept();
    return true;
  }
  return QWidget::event(event);
}

}  // namespace trocar::trainer
