#include "control/mirror_station.h"

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <QScreen>
#include <QShortcut>

#include "panels/mirror_dialog.h"
#include "ui_kit/action_table.h"
#include "views/patient/patient_view.h"

namespace trocar::trainer {
namespace {

bool are_same(const scene::CameraView& a, const scene::CameraView& b) {
  constexpr double kUnseen = 1e-6;
  return (a.eye_P - b.eye_P).norm() < kUnseen && (a.focus_P - b.focus_P).norm() < kUnseen &&
         (a.up_P - b.up_P).norm() < kUnseen && std::abs(a.view_angle_rad - b.view_angle_rad) < kUnseen;
}

}  // namespace

MirrorStation::MirrorStation(QMainWindow& window)
    : QObject(&window),
      window_(window),
      mirror_(window, tr("Window mirrored: %1 switches mirroring off").arg(keys_text(Action::kMirroring))) {
  auto* key = new QShortcut(key_of(Action::kMirroring), &window);
  connect(key, &QShortcut::activated, this, &MirrorStation::toggle);
  set(load_mirror_settings());
}

void MirrorStation::fill_menu(QMenu& menu) {
  QAction* turn = menu.addAction(tr("Switch window mirroring on or off  (%1)").arg(keys_text(Action::kMirroring)));
  turn->setObjectName(QStringLiteral("mirror-toggle"));
  connect(turn, &QAction::triggered, this, &MirrorStation::toggle);
  QAction* dialog = menu.addAction(tr("Mirror workstation …"));
  dialog->setObjectName(QStringLiteral("mirror-dialog"));
  connect(dialog, &QAction::triggered, this, &MirrorStation::show_dialog);
}

void MirrorStation::set(const MirrorSettings& settings) {
  settings_ = settings;
  if (settings.axis != MirrorAxis::kNone) last_axis_ = settings.axis;
  mirror_.set_axis(settings.axis);
}

void MirrorStation::toggle() {
  MirrorSettings next = settings_;
  next.axis = settings_.axis == MirrorAxis::kNone ? last_axis_ : MirrorAxis::kNone;
  set(next);
  save_mirror_settings(next);
  if (auto* dialog = window_.findChild<MirrorDialog*>()) dialog->close();  // it shows the other setting
}

void MirrorStation::show_dialog() {
  if (auto* open = window_.findChild<MirrorDialog*>()) return open->raise();
  auto* dialog = new MirrorDialog(settings_, &window_);
  connect(dialog, &MirrorDialog::changed, this, [this](const MirrorSettings& settings) {
    set(settings);
    save_mirror_settings(settings);
  });
  dialog->show();
}

void MirrorStation::update_camera(PatientView& view, const Pose& X_PW) const {
  view.set_row_on_screen([this](int row) { return mirror_.row_on_screen(row); });
  if (!settings_.is_camera_fixed) return;
  const QPointF middle = window_.rect().center();
  const QPointF view_middle = view.mapTo(&window_, view.rect().center());
  const QScreen* screen = window_.screen();
  ViewPlace place;
  place.right_px = view_middle.x() - middle.x();
  place.down_px = view_middle.y() - middle.y();
  place.rows = view.height();
  place.mm_per_pixel = settings_.screen_width_mm / std::max(1, screen->size().width());
  const scene::CameraView wanted = moved(X_PW, mirror_camera_W(settings_, place));
  if (view.follow() != scene::FollowMode::kFree) view.set_follow(scene::FollowMode::kFree);
  if (!are_same(view.view(), wanted)) view.set_view(wanted);
}

}  // namespace trocar::trainer
