#pragma once

#include <QObject>

#include "geometry/pose.h"
#include "panels/mirror_settings.h"

class QMainWindow;
class QMenu;

namespace trocar::trainer {

class PatientView;

/// Support of a mirror workstation (paper B): mirrors the window by F8 or the menu, stores the settings, and fixes the
/// camera of a 3D view to the device.
class MirrorStation : public QObject {
  Q_OBJECT

 public:
  explicit MirrorStation(QMainWindow& window);

  void fill_menu(QMenu& menu);
  const MirrorSettings& settings() const noexcept { return settings_; }
  void set(const MirrorSettings& settings);
  /// F8: mirrors the window, or restores it.
  void toggle();
  /// Sets the view's camera before it draws, if the camera is fixed. X_PW: pose of W, the frame of the room, in P.
  void update_camera(PatientView& view, const Pose& X_PW) const;

 private:
  void show_dialog();

  QMainWindow& window_;
  WindowMirror mirror_;
  MirrorSettings settings_;
  MirrorAxis last_axis_ = MirrorAxis::kLeftRight;  ///< Axis that F8 uses.
};

}  // namespace trocar::trainer
