#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

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

/// Action of a key; empty for other keys.
using Act = void (*)(PatientView& view);

void toggle(PatientView& view, scene::FollowMode mode) {
  view.set_follow(view.follow() == mode ? scene::FollowMode::kFree : mode);
}

void turn(PatientView& view, double right, double up) {
  view.set_view(scene::orbited(view.view(), right, up));
}

Act act_of(int key) {
  static constexpr std::pair<int, Act> kActs[] = {
      {Qt::Key_1, [](PatientView& v) { v.set_camera(scene::CameraPreset::kAnterior); }},
      {Qt::Key_2, [](PatientView& v) { v.set_camera(scene::CameraPreset::kRightAnteriorOblique); }},
      {Qt::Key_3, [](PatientView& v) { v.set_camera(scene::CameraPreset::kRight); }},
      {Qt::Key_4, [](PatientView& v) { v.set_camera(scene::CameraPreset::kLeft); }},
      {Qt::Key_5, [](PatientView& v) { v.set_camera(scene::CameraPreset::kPosterior); }},
      {Qt::Key_6, [](PatientView& v) { v.set_camera(scene::CameraPreset::kCranial); }},
      {Qt::Key_T, [](PatientView& v) { toggle(v, scene::FollowMode::kTip); }},
      {Qt::Key_L, [](PatientView& v) { toggle(v, scene::FollowMode::kAlongNeedle); }},
      {Qt::Key_B, [](PatientView& v) { toggle(v, scene::FollowMode::kSide); }},
      {Qt::Key_O, [](PatientView& v) { v.set_guidance_visible(!v.is_guidance_visible()); }},
      {Qt::Key_I, [](PatientView& v) { v.set_landmarks_visible(!v.are_landmarks_visible()); }},
      {Qt::Key_Home, [](PatientView& v) { v.reset_camera(); }},
      {Qt::Key_Left, [](PatientView& v) { turn(v, -kKeyOrbit_rad, 0.0); }},
      {Qt::Key_Right, [](PatientView& v) { turn(v, kKeyOrbit_rad, 0.0); }},
      {Qt::Key_Up, [](PatientView& v) { turn(v, 0.0, kKeyOrbit_rad); }},
      {Qt::Key_Down, [](PatientView& v) { turn(v, 0.0, -kKeyOrbit_rad); }},
      {Qt::Key_Plus, [](PatientView& v) { v.set_view(scene::zoomed(v.view(), kZoomPerNotch)); }},
      {Qt::Key_Minus, [](PatientView& v) { v.set_view(scene::zoomed(v.view(), 1.0 / kZoomPerNotch)); }},
  };
  const auto* found = std::find_if(std::begin(kActs), std::end(kActs), [key](const auto& a) { return a.first == key; });
  return found == std::end(kActs) ? nullptr : found->second;
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
  const Act act = act_of(event->key());
  if (act == nullptr) return QWidget::keyPressEvent(event);
  act(*this);
  Q_EMIT changed();
}

/// With the focus here, the view's keys take precedence over shortcuts of the window.
bool PatientView::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    const auto* key = static_cast<QKeyEvent*>(event);
    const bool is_plain = (key->modifiers() & ~(Qt::KeypadModifier | Qt::ShiftModifier)) == Qt::NoModifier;
    const bool is_letter = key->key() >= Qt::Key_A && key->key() <= Qt::Key_Z;
    const bool has_shift = (key->modifiers() & Qt::ShiftModifier) != 0;
    if (is_plain && !(is_letter && has_shift) && act_of(key->key()) != nullptr) {
      event->accept();
      return true;
    }
  }
  return QWidget::event(event);
}

}  // namespace trocar::trainer
