#pragma once

#include <QObject>

#include "geometry/pose.h"
#include "panels/mirror_settings.h"

class QMainWindow;
class QMenu;

namespace trocar::trainer {

class PatientView;

/// The mirror of the window (paper B's workstation): turned over by F8 or the menu, settings kept, and the camera of a
/// 3D view fixed to the device.
class MirrorStation : public QObject {
  Q_OBJECT

 public:
  explicit MirrorStation(QMainWindow& window);

  void fill_menu(QMenu& menu);
  const MirrorSettings& settings() const noexcept { return settings_; }
  void set(const MirrorSettings& settings);
  /// F8: over, and back.
  void toggle();
  /// Before the view draws: its camera, where it is fixed. X_PW: the room about the device in the patient.
  void update_camera(PatientView& view, const Pose& X_PW) const;

 private:
  void show_dialog();

  QMainWindow& window_;
  WindowMirror mirror_;
  MirrorSettings settings_;
  MirrorAxis last_axis_ = MirrorAxis::kLeftRight;  ///< That F8 takes.
};

}  // namespace trocar::trainer
