// The keys of PatientView.
#include <QKeyEvent>

#include "views/patient_view.h"

namespace trocar::trainer {
namespace {

constexpr double kKeyOrbit_rad = 0.12;
constexpr double kZoomPerKey = 1.15;

}  // namespace

void PatientView::keyPressEvent(QKeyEvent* event) {
  const auto turn = [&](double right, double up) { set_view(orbited(view(), right, up)); };
  const auto toggle = [&](FollowMode mode) { set_follow(follow() == mode ? FollowMode::kFree : mode); };
  switch (event->key()) {
    case Qt::Key_1:
      set_camera(CameraPreset::kAnterior);
      break;
    case Qt::Key_2:
      set_camera(CameraPreset::kRightAnteriorOblique);
      break;
    case Qt::Key_3:
      set_camera(CameraPreset::kRight);
      break;
    case Qt::Key_4:
      set_camera(CameraPreset::kLeft);
      break;
    case Qt::Key_5:
      set_camera(CameraPreset::kPosterior);
      break;
    case Qt::Key_6:
      set_camera(CameraPreset::kCranial);
      break;
    case Qt::Key_F:
      toggle(FollowMode::kTip);
      break;
    case Qt::Key_L:
      toggle(FollowMode::kAlongNeedle);
      break;
    case Qt::Key_N:
      toggle(FollowMode::kSide);
      break;
    case Qt::Key_G:
      set_guidance_visible(!is_guidance_visible_);
      break;
    case Qt::Key_M:
      set_landmarks_visible(!are_landmarks_visible_);
      break;
    case Qt::Key_Home:
      reset_camera();
      break;
    case Qt::Key_Left:
      turn(-kKeyOrbit_rad, 0.0);
      break;
    case Qt::Key_Right:
      turn(kKeyOrbit_rad, 0.0);
      break;
    case Qt::Key_Up:
      turn(0.0, kKeyOrbit_rad);
      break;
    case Qt::Key_Down:
      turn(0.0, -kKeyOrbit_rad);
      break;
    case Qt::Key_Plus:
      set_view(zoomed(view(), kZoomPerKey));
      break;
    case Qt::Key_Minus:
      set_view(zoomed(view(), 1.0 / kZoomPerKey));
      break;
    default:
      return QWidget::keyPressEvent(event);
  }
  Q_EMIT changed();
}

}  // namespace trocar::trainer
